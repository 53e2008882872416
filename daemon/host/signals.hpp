#pragma once

namespace mpm::host {

/// SIGTERM and SIGINT as something to ask for. Made before any thread starts, so that all threads
/// inherit the blocked signals and none is interrupted.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal();

  /// True once one of them came.
  [[nodiscard]] bool received();

 private:
  int fd_;
  bool received_ = false;
};

}  // namespace mpm::host
