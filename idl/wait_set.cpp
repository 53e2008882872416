#include "idl/wait_set.hpp"

#include <algorithm>

#include "core/parallel/mutex.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::idl {

/// What Cyclone's threads ring when something comes.
struct WaitSet::Bell {
  Mutex mutex;
  ConditionVariable changed;
  bool rung MPM_GUARDED_BY(mutex) = false;

  void ring() {
    {
      const MutexLock lock(mutex);
      rung = true;
    }
    changed.notify_one();
  }
  void silence() {
    const MutexLock lock(mutex);
    rung = false;
  }
  void wait_until(std::chrono::steady_clock::time_point end) {
    MutexLock lock(mutex);
    while (!rung && changed.wait_until(lock, end)) {
    }
  }
};

WaitSet::WaitSet() : bell_(std::make_unique<Bell>()) {}

// Afterwards no thread of Cyclone rings any more, nor is about to.
WaitSet::~WaitSet() {
  for (const dds_entity_t reader : readers_) dds_set_listener(reader, nullptr);
}

void WaitSet::attach(dds_entity_t condition) {
  const dds_entity_t reader = check(dds_get_parent(condition), "reader of a condition");
  dds_listener_t* listener = dds_create_listener(bell_.get());
  dds_lset_data_available(listener,
                          [](dds_entity_t, void* bell) { static_cast<Bell*>(bell)->ring(); });
  const dds_return_t result = dds_set_listener(reader, listener);
  dds_delete_listener(listener);
  check(result, "listen to a reader");
  conditions_.push_back(condition);
  readers_.push_back(reader);
}

bool WaitSet::anything() const {
  return std::any_of(conditions_.begin(), conditions_.end(), [](dds_entity_t condition) {
    return check(dds_triggered(condition), "ask a condition") > 0;
  });
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) const {
  bell_->silence();  // before the look, so that what comes after it is heard
  if (anything()) return true;
  bell_->wait_until(std::chrono::steady_clock::now() + timeout);
  return anything();
}

}  // namespace mpm::idl
