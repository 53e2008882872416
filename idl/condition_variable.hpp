#pragma once

#include <chrono>
#include <condition_variable>

#include "core/parallel/mutex.hpp"

namespace mpm {

/// What threads that hold a lock wait for. Wakes up for no reason too: wait in a loop.
class ConditionVariable {
 public:
  void wait(MutexLock& lock) { changed_.wait(lock.lock_); }
  /// False at `deadline`.
  [[nodiscard]] bool wait_until(MutexLock& lock, std::chrono::steady_clock::time_point deadline) {
    return changed_.wait_until(lock.lock_, deadline) == std::cv_status::no_timeout;
  }
  void notify_one() { changed_.notify_one(); }
  void notify_all() { changed_.notify_all(); }

 private:
  std::condition_variable_any changed_;
};

}  // namespace mpm
