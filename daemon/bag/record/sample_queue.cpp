#include "daemon/bag/record/sample_queue.hpp"

#include <utility>

namespace mpm::bag {

void SampleQueue::push(std::vector<RecordedSample>& samples) {
  {
    const MutexLock lock(mutex_);
    for (RecordedSample& sample : samples) {
      const std::size_t bytes = sizeof sample + sample.sample.cdr.size();
      if (bytes_ + bytes > most_bytes_) {
        ++dropped_;
        continue;
      }
      bytes_ += bytes;
      samples_.push_back(std::move(sample));
    }
  }
  samples.clear();
  filled_.notify_one();
}

bool SampleQueue::pop(std::vector<RecordedSample>& samples, std::chrono::milliseconds patience) {
  samples.clear();
  const auto deadline = std::chrono::steady_clock::now() + patience;
  MutexLock lock(mutex_);
  while (!closed_ && samples_.empty() && filled_.wait_until(lock, deadline)) {
  }
  std::swap(samples, samples_);
  bytes_ = 0;
  return !closed_ || !samples.empty();
}

void SampleQueue::close() {
  const MutexLock lock(mutex_);
  closed_ = true;
  filled_.notify_one();
}

std::uint64_t SampleQueue::dropped() const {
  const MutexLock lock(mutex_);
  return dropped_;
}

}  // namespace mpm::bag
