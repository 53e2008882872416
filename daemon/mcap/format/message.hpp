#pragma once

#include <cstdint>
#include <limits>

#include "daemon/mcap/format/definitions.hpp"

namespace mpm::mcap {

/// A message with what is known about it; valid until the next one is read.
struct Message {
  const Channel* channel = nullptr;
  const Schema* schema = nullptr;  ///< null where the channel has none
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0;      ///< when it was received, since 1970
  std::int64_t publish_time_ns = 0;  ///< when it was sent
  ByteView data;
};

/// Log times to read: start <= t < end.
struct TimeRange {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();

  [[nodiscard]] bool everything() const {
    return start_ns <= 0 && end_ns == std::numeric_limits<std::int64_t>::max();
  }
};

/// Messages one after the other.
class MessageSource {
 public:
  MessageSource() = default;
  MessageSource(const MessageSource&) = delete;
  MessageSource& operator=(const MessageSource&) = delete;
  virtual ~MessageSource() = default;

  /// False at the end. Throws config::InputError where the file is damaged.
  [[nodiscard]] virtual bool next(Message& message) = 0;
  /// What the file told so far.
  [[nodiscard]] virtual const Definitions& definitions() const = 0;
};

}  // namespace mpm::mcap
