#include "config/cli/color.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>

namespace mpm::cli {

void add_no_color(CLI::App& command) {
  command.add_flag_callback(
      "--no-color", [] { setenv("NO_COLOR", "1", 1); }, "words only; also with NO_COLOR set");
}

bool color_refused() {
  const char* said = std::getenv("NO_COLOR");
  return said != nullptr && *said != '\0';
}

}  // namespace mpm::cli
