#include "daemon/http/worker_queue.hpp"

#include <utility>

namespace mpm::http {

WorkerQueue::WorkerQueue(std::size_t threads, std::size_t most_waiting)
    : most_waiting_(most_waiting) {
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

WorkerQueue::~WorkerQueue() { finish(); }

bool WorkerQueue::add(std::function<void()> job) {
  const MutexLock lock(mutex_);
  if (jobs_.size() >= most_waiting_) return false;
  jobs_.push_back(std::move(job));
  changed_.notify_one();
  return true;
}

void WorkerQueue::run() {
  for (;;) {
    std::function<void()> job;
    {
      MutexLock lock(mutex_);
      while (jobs_.empty() && !finished_) changed_.wait(lock);
      if (jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job();
  }
}

void WorkerQueue::finish() {
  {
    const MutexLock lock(mutex_);
    finished_ = true;
    changed_.notify_all();
  }
  for (std::thread& thread : threads_)
    if (thread.joinable()) thread.join();
}

}  // namespace mpm::http
