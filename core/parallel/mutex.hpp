#pragma once

#include <mutex>

// Who holds which lock, said where clang can check it (-Wthread-safety;
// tests/style/check_locks.sh): std::mutex says nothing of the kind.
#ifdef __clang__
#define MPM_THREADS(attribute) __attribute__((attribute))
#else
#define MPM_THREADS(attribute)
#endif

/// Of a member: only with `mutex` held.
#define MPM_GUARDED_BY(mutex) MPM_THREADS(guarded_by(mutex))
/// Of a function: its caller holds `mutex`.
#define MPM_REQUIRES(mutex) MPM_THREADS(requires_capability(mutex))

namespace mpm {

/// A std::mutex that clang can follow.
class MPM_THREADS(capability("mutex")) Mutex {
 public:
  void lock() MPM_THREADS(acquire_capability()) { mutex_.lock(); }
  void unlock() MPM_THREADS(release_capability()) { mutex_.unlock(); }
  [[nodiscard]] bool try_lock() MPM_THREADS(try_acquire_capability(true)) {
    return mutex_.try_lock();
  }

 private:
  std::mutex mutex_;
};

/// Holds a mutex to the end of the block, but for what lies between unlock() and lock().
class MPM_THREADS(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) MPM_THREADS(acquire_capability(mutex)) : lock_(mutex) {}
  /// Of one that is locked already, by try_lock().
  MutexLock(Mutex& mutex, std::adopt_lock_t adopt) MPM_REQUIRES(mutex) : lock_(mutex, adopt) {}
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;
  // NOLINTNEXTLINE(modernize-use-equals-default): the annotation is read of bodies only
  ~MutexLock() MPM_THREADS(release_capability()) {}

  void lock() MPM_THREADS(acquire_capability()) { lock_.lock(); }
  void unlock() MPM_THREADS(release_capability()) { lock_.unlock(); }

 private:
  friend class ConditionVariable;
  std::unique_lock<Mutex> lock_;
};

}  // namespace mpm
