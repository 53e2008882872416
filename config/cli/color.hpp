#pragma once

namespace CLI {
class App;
}

namespace mpm::cli {

/// Declares --no-color, which says for the process what NO_COLOR says (no-color.org).
void add_no_color(CLI::App& command);
/// True where either asks for words only.
[[nodiscard]] bool color_refused();

}  // namespace mpm::cli
