#include "daemon/app/commands/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/host/terminal.hpp"

namespace mpm::app {

ProgressBar::ProgressBar(std::string what, bool quiet, Clock::duration delay)
    : what_(std::move(what)),
      shown_(!quiet && host::is_terminal(STDERR_FILENO)),
      due_(Clock::now() + delay) {}

ProgressBar::~ProgressBar() {
  if (shown_ && percent_ >= 0) std::cerr << "\r\x1b[K" << std::flush;
}

void ProgressBar::show(double share) {
  const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
  if (!shown_ || percent == percent_ || Clock::now() < due_) return;
  percent_ = percent;
  std::cerr << '\r' << progress_text(what_, percent, host::terminal_width(STDERR_FILENO))
            << std::flush;
}

std::string progress_text(const std::string& what, int percent, std::size_t width) {
  constexpr std::size_t kMostCells = 40, kFewestCells = 5;
  const std::string number = std::to_string(percent) + " %";
  const std::size_t beside = what.size() + std::string_view(" [] 100 %").size() + 1;  // the cursor
  if (width < beside + kFewestCells)
    return what.size() + 1 + number.size() < width ? what + ' ' + number : number;
  const std::size_t cells = std::min(kMostCells, width - beside);
  const std::size_t done = static_cast<std::size_t>(percent) * cells / 100;
  return what + " [" + std::string(done, '#') + std::string(cells - done, '.') + "] " + number;
}

}  // namespace mpm::app
