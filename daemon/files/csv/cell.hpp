#pragma once

#include <optional>
#include <string_view>

/// What a cell of a data file says.
namespace mpm::files {

/// A number (decimal point or, with `decimal_comma`, either), infinite where no double is as large,
/// or NaN for the words that mean "no value" (empty, nan, Bad, No Data, I/O Timeout, ...). Nothing
/// for any other text.
[[nodiscard]] std::optional<double> parse_value(std::string_view text, bool decimal_comma);

/// True for a text such as 1.050, which is 1050 where the comma is the decimal point.
[[nodiscard]] bool may_be_thousands(std::string_view text);

/// True for a text that is no attempt at a number: the name of a state, such as `Manual` or
/// `Over Range`, or a message.
[[nodiscard]] bool is_state(std::string_view text);

/// Without case, as file headers and words are compared.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace mpm::files
