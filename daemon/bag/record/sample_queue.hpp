#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel/mutex.hpp"
#include "idl/condition_variable.hpp"
#include "idl/raw_sample.hpp"

namespace mpm::bag {

struct RecordedSample {
  std::size_t topic = 0;         ///< index of the recorder's topic
  std::int64_t log_time_ns = 0;  ///< when it was received, UTC since 1970
  idl::RawSample sample;
  std::int64_t age_ns = 0;  ///< when it was received, by its source time and the machine's clock
};

/// From the thread that takes samples to the one that writes them. Bounded: what does not fit is
/// dropped and counted, for whoever waits here would slow down the process that is recorded.
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Moves the samples in; `samples` is empty afterwards.
  void push(std::vector<RecordedSample>& samples);
  /// Moves out all there is, after at most `patience`; false once it is closed and empty.
  [[nodiscard]] bool pop(std::vector<RecordedSample>& samples, std::chrono::milliseconds patience);
  /// Nothing more will come.
  void close();

  [[nodiscard]] std::uint64_t dropped() const;

 private:
  const std::size_t most_bytes_;
  mutable Mutex mutex_;
  ConditionVariable filled_;
  std::vector<RecordedSample> samples_ MPM_GUARDED_BY(mutex_);
  std::size_t bytes_ MPM_GUARDED_BY(mutex_) = 0;
  std::uint64_t dropped_ MPM_GUARDED_BY(mutex_) = 0;
  bool closed_ MPM_GUARDED_BY(mutex_) = false;
};

}  // namespace mpm::bag
