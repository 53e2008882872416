#pragma once

namespace mpm::app {

/// A line on standard error that shows how far something is; nothing where that is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< wipes the line

  void show(double share);

 private:
  bool shown_;
  int percent_ = -1;
};

}  // namespace mpm::app
