#pragma once

#include <chrono>
#include <string>

namespace mpm::app {

/// What a long-running command has to tell, on standard error: one line that is rewritten on a
/// terminal, a line now and then anywhere else.
class StatusLine {
 public:
  using Clock = std::chrono::steady_clock;

  StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  ~StatusLine();  ///< leaves the cursor on a new line

  /// True when the next text is due.
  [[nodiscard]] bool due(Clock::time_point now);
  void show(const std::string& text);
  /// A line that stays.
  void say(const std::string& text);
  [[nodiscard]] bool terminal() const { return terminal_; }

 private:
  bool terminal_;
  bool open_ = false;
  Clock::time_point next_;
};

/// "12.3 MB"
[[nodiscard]] std::string bytes_text(double bytes);

}  // namespace mpm::app
