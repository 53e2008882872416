#pragma once

#include <cstddef>

namespace mpm::host {

[[nodiscard]] bool is_terminal(int descriptor);
/// Columns of the terminal behind `descriptor`; what $COLUMNS says where there is none, else 80.
[[nodiscard]] std::size_t terminal_width(int descriptor);
/// Whether colours are wanted there: it is a terminal, and NO_COLOR (no-color.org) is not set.
[[nodiscard]] bool wants_color(int descriptor);

}  // namespace mpm::host
