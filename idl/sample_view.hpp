#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/signal/frame.hpp"
#include "idl/topics.hpp"

namespace mpm::idl {

/// An input sample without DDS types; valid as long as the sample it looks at.
struct SampleView {
  SignalKind kind = SignalKind::kMv;
  std::string_view unit;
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::span<const double> values;
  std::span<const std::uint8_t> quality;  ///< codes as in `Quality`; empty = all good
  std::uint64_t writer = 0;               ///< as in SampleInfo
};

[[nodiscard]] SampleView view_of(SignalKind kind, const mpm_Sample& sample,
                                 std::uint64_t writer = 0);

/// A sample that borrows `unit` and the values of one block of `frame`, ready to be written.
[[nodiscard]] mpm_Sample sample_of(const char* unit, const Frame& frame, SignalKind kind);

}  // namespace mpm::idl
