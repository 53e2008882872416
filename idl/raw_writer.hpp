#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "idl/participant.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::idl {

/// How a sample of one of our types is changed on its way; nothing by default.
struct SampleChange {
  std::string unit;                ///< the new unit; empty = as it is
  std::int64_t add_intervals = 0;  ///< mpm::Sample only
  std::int64_t add_time_ns = 0;    ///< to the time inside; mpm::Sample only

  [[nodiscard]] bool any() const { return !unit.empty() || add_intervals != 0 || add_time_ns != 0; }
};

/// What became of a raw sample.
enum class WriteResult {
  kWritten,
  kNotCdr,   ///< the bytes are no sample of the type
  kTimeout,  ///< readers did not take it in time (kLossless: 10 s)
};

/// Writes recorded samples of one topic with the time stamps they had. For replay; the monitor
/// never makes one.
class RawWriter {
 public:
  RawWriter(const Participant& participant, const KnownTopic& topic, WriterPace pace);
  RawWriter(RawWriter&&) noexcept;
  RawWriter& operator=(RawWriter&&) noexcept;
  ~RawWriter();

  [[nodiscard]] WriteResult write(std::span<const std::byte> cdr, std::int64_t source_time_ns,
                                  const SampleChange& change = {}) const;
  /// `key`: as a RawSample that is not valid has it. `state`: kDisposed or kNoWriters.
  [[nodiscard]] WriteResult end_instance(std::span<const std::byte> key, InstanceState state,
                                         std::int64_t source_time_ns,
                                         const SampleChange& change = {}) const;

  [[nodiscard]] int matched_readers() const;
  /// Asks the readers that are known to say that they know this writer too: what is written before
  /// that is lost for a reader that keeps nothing. False after `timeout`.
  [[nodiscard]] bool greet(std::chrono::nanoseconds timeout) const;
  /// Waits until the readers have all that was written; false after `timeout`.
  [[nodiscard]] bool flush(std::chrono::nanoseconds timeout) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mpm::idl
