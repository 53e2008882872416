#include "daemon/app/commands/progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>
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
  constexpr int kWidth = 40;
  const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
  if (!shown_ || percent == percent_ || Clock::now() < due_) return;
  percent_ = percent;
  const auto done = static_cast<std::size_t>(percent * kWidth / 100);
  std::cerr << '\r' << what_ << " [" << std::string(done, '#') << std::string(kWidth - done, '.')
            << "] " << percent << " %" << std::flush;
}

}  // namespace mpm::app
