#pragma once

#include <dds/dds.h>

#include <cstdint>

namespace mpm::idl {

/// What a sample says of its instance.
enum class InstanceState { kAlive, kDisposed, kNoWriters };

/// What comes with the values of a sample.
struct SampleInfo {
  std::int64_t source_time_ns = 0;  ///< when it was written, UTC since 1970
  InstanceState state = InstanceState::kAlive;
  bool valid = true;  ///< false: it only says that the state changed, and has nothing but its key
  std::uint64_t writer = 0;  ///< the same number for all samples of one writer
};

[[nodiscard]] SampleInfo info_of(const dds_sample_info_t& info);

}  // namespace mpm::idl
