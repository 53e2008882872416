#pragma once

#include <optional>
#include <string_view>

#include "core/signal/frame.hpp"

/// What a cell of a data file says.
namespace mpm::files {

/// A number (decimal point or, with `decimal_comma`, either), infinite where no double is as large,
/// or NaN for the words that mean "no value" (empty, nan, Bad, No Data, I/O Timeout, ...). Nothing
/// for any other text.
[[nodiscard]] std::optional<double> parse_value(std::string_view text, bool decimal_comma);

/// good | uncertain | bad, OPC DA codes (192 | 64 | 0 with substatus) or OPC UA status codes; empty
/// = good. Nothing for any other text.
[[nodiscard]] std::optional<Quality> parse_quality(std::string_view text);

/// Without case, as file headers and words are compared.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace mpm::files
