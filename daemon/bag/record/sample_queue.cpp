#include "daemon/bag/record/sample_queue.hpp"

#include <utility>

namespace mpm::bag {

void SampleQueue::push(std::vector<RecordedSample>& samples) {
  {
    const std::lock_guard lock(mutex_);
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
  std::unique_lock lock(mutex_);
  filled_.wait_for(lock, patience, [this] { return closed_ || !samples_.empty(); });
  std::swap(samples, samples_);
  bytes_ = 0;
  return !closed_ || !samples.empty();
}

void SampleQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  filled_.notify_one();
}

std::uint64_t SampleQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace mpm::bag
