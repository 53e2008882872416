#pragma once

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace mpm::host {

/// Signals as something to ask for. Made before any thread starts, so that all threads inherit the
/// blocked signals and none is interrupted.
class AwaitedSignal {
 public:
  /// But for those that are ignored already.
  explicit AwaitedSignal(std::initializer_list<int> signals);
  AwaitedSignal(const AwaitedSignal&) = delete;
  AwaitedSignal& operator=(const AwaitedSignal&) = delete;
  ~AwaitedSignal();

  /// True where one of them came since the last call.
  [[nodiscard]] bool take();

 private:
  int fd_;
};

/// SIGTERM, SIGINT and SIGHUP, or others.
class StopSignal {
 public:
  explicit StopSignal(std::initializer_list<int> signals = {SIGTERM, SIGINT, SIGHUP})
      : signal_(signals) {}

  /// True once one of them came. From any thread.
  [[nodiscard]] bool received();

 private:
  AwaitedSignal signal_;
  std::atomic<bool> received_ = false;
};

}  // namespace mpm::host
