#pragma once

#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::http {

/// Threads that answer requests, and a bounded number of those that wait for one.
class WorkerQueue {
 public:
  WorkerQueue(std::size_t threads, std::size_t most_waiting);
  WorkerQueue(const WorkerQueue&) = delete;
  WorkerQueue& operator=(const WorkerQueue&) = delete;
  ~WorkerQueue();

  /// False where the queue is full.
  [[nodiscard]] bool add(std::function<void()> job);
  /// Ends the threads after what they have to do; nothing may be added any more.
  void finish();

 private:
  void run();

  std::size_t most_waiting_;
  Mutex mutex_;
  ConditionVariable changed_;
  std::deque<std::function<void()>> jobs_ MPM_GUARDED_BY(mutex_);
  bool finished_ MPM_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace mpm::http
