#include "daemon/host/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>

#include "config/cli/color.hpp"

namespace mpm::host {

bool is_terminal(int descriptor) { return isatty(descriptor) != 0; }

std::size_t terminal_width(int descriptor) {
  constexpr std::size_t kUsual = 80;
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* said = std::getenv("COLUMNS");
  const long columns = said == nullptr ? 0 : std::strtol(said, nullptr, 10);
  return columns > 0 ? static_cast<std::size_t>(columns) : kUsual;
}

bool wants_color(int descriptor) { return is_terminal(descriptor) && !cli::color_refused(); }

}  // namespace mpm::host
