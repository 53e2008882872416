#pragma once

#include <string>
#include <string_view>

namespace mpm::mcap {

/// A text out of a file, fit for one line of a message or a terminal: control characters become
/// question marks, and what is very long ends in dots.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace mpm::mcap
