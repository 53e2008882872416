#pragma once

#include <chrono>
#include <thread>

#include "core/parallel/mutex.hpp"
#include "idl/condition_variable.hpp"
#include "idl/entity.hpp"

namespace mpm::idl {

/// A loop that also looks for a signal to end sleeps no longer at once.
inline constexpr std::chrono::milliseconds kLongestWait{50};

/// Sleeps until one of several readers, of any participants of this process, has something.
///
/// How long it sleeps is reckoned on the steady clock, to a second. Cyclone's wait sets (0.10) wait
/// for a moment of the machine's clock, so a clock that is set back by an hour meanwhile would make
/// the wait an hour longer: a thread wakes the sleeper once a second.
class WaitSet {
 public:
  WaitSet();
  WaitSet(const WaitSet&) = delete;
  WaitSet& operator=(const WaitSet&) = delete;
  ~WaitSet();

  /// `condition`: Reader::readable(); must outlive the wait set.
  void attach(dds_entity_t condition);
  /// True if something is there to take, false after `timeout`.
  [[nodiscard]] bool wait(std::chrono::nanoseconds timeout) const;
  /// Whether `wait` would return at once.
  [[nodiscard]] bool ready() const;

 private:
  void wake_now_and_then();

  Entity wait_set_;
  Entity waker_;  // a condition that only the thread triggers
  Mutex mutex_;
  ConditionVariable changed_;
  bool over_ MPM_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace mpm::idl
