#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace mpm::app {

/// A line on standard error that shows how far something is; nothing where that is no terminal.
class ProgressBar {
 public:
  using Clock = std::chrono::steady_clock;

  /// `what` is being done. The line appears after `delay`: what is over by then needs none.
  explicit ProgressBar(std::string what, bool quiet, Clock::duration delay = {});
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< wipes the line

  void show(double share);

 private:
  std::string what_;
  bool shown_;
  Clock::time_point due_;
  int percent_ = -1;
};

/// `reading [####......] 40 %` in less than `width` columns; where they are too few, without the
/// bar.
[[nodiscard]] std::string progress_text(const std::string& what, int percent, std::size_t width);

}  // namespace mpm::app
