#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/sample_info.hpp"

namespace mpm::idl {

/// One sample as it was on the wire: CDR with its 4-byte encapsulation header, in the byte order of
/// this machine.
struct RawSample : SampleInfo {
  std::vector<std::byte> cdr;  ///< all of the sample; of an instance that is gone only its key
};

/// The key `unit` of a sample (or of a key) of one of our types: the first string in it. Empty
/// where the bytes are no such thing.
[[nodiscard]] std::string unit_of(std::span<const std::byte> cdr);
/// The first `count` strings of a sample of a type that begins with so many; empty ones where the
/// bytes are no such thing.
[[nodiscard]] std::vector<std::string> leading_texts(std::span<const std::byte> cdr,
                                                     std::size_t count);

/// The source time and interval that a raw mpm::Sample carries.
struct SampleStamp {
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
};
/// Nothing where the bytes are no mpm::Sample.
[[nodiscard]] std::optional<SampleStamp> stamp_of(std::span<const std::byte> cdr);

}  // namespace mpm::idl
