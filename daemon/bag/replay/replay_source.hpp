#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "idl/raw_sample.hpp"

namespace mpm::bag {

/// A sample of a recording; the views live until the next one is asked for.
struct ReplaySample {
  std::string topic;
  std::int64_t log_time_ns = 0;     ///< when it was received
  std::int64_t source_time_ns = 0;  ///< when it was written
  idl::InstanceState state = idl::InstanceState::kAlive;
  std::span<const std::byte> cdr;  ///< the key, where `state` is not kAlive
};

/// The samples of one or more recordings in the order in which they were received.
class ReplaySource {
 public:
  ReplaySource() = default;
  ReplaySource(const ReplaySource&) = delete;
  ReplaySource& operator=(const ReplaySource&) = delete;
  virtual ~ReplaySource() = default;

  /// False at the end.
  [[nodiscard]] virtual bool next(ReplaySample& sample) = 0;
  /// Back to the first one.
  virtual void rewind() = 0;
};

}  // namespace mpm::bag
