#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// UTF-8 as RFC 3629 has it: no surrogates, nothing beyond U+10FFFF, no longer form than needed.
namespace mpm {

/// Where the first byte stands that is no UTF-8; npos where all is.
[[nodiscard]] std::size_t find_invalid_utf8(std::string_view text);

/// Bytes of the character that `text` begins with; 0 where that is none, or the text is empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// A text in ISO 8859-1, which any bytes are.
[[nodiscard]] std::string utf8_from_latin1(std::string_view text);

/// Blanks at which no line may break, or of another width (U+00A0, U+2007, U+2009, U+202F), become
/// plain ones: what spreadsheets and browsers write before PM, or between a number and its unit.
void make_blanks_plain(std::string& text);

}  // namespace mpm
