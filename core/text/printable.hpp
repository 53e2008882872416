#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mpm {

/// The longest name that a unit file may give, in bytes.
inline constexpr std::size_t kLongestName = 128;

/// A text from outside (the bus, a file, a pipe), fit for one line of a log or a terminal and for
/// JSON: no control character, no byte that is no UTF-8 and nothing that turns the direction of
/// writing comes through as such, but as `\n`, `\x1b` or `\u{202e}`. Of what is longer than
/// `longest` bytes the beginning, and dots. Ordinary text is as it was.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = kLongestName);

}  // namespace mpm
