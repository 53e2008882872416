#include "daemon/http/worker_queue.hpp"

#include <utility>

namespace mpm::http {

WorkerQueue::WorkerQueue(std::size_t threads, std::size_t most_waiting)
    : most_waiting_(most_waiting) {
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

WorkerQueue::~WorkerQueue() { finish(); }

void WorkerQueue::add(std::function<void()> job) {
  MutexLock lock(mutex_);
  while (jobs_.size() >= most_waiting_) changed_.wait(lock);
  jobs_.push_back(std::move(job));
  changed_.notify_all();
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
      changed_.notify_all();
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
