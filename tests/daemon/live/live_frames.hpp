#pragma once

#include <algorithm>

#include "core/signal/frame.hpp"

namespace mpm::test {

/// Interval `k` at k seconds: every CV k, every MV 10 k, every DV 100 k.
[[nodiscard]] inline Frame frame_at(std::int64_t k, const SignalCounts& counts) {
  Frame frame(counts);
  frame.interval = k;
  frame.source_time_ns = k * 1'000'000'000;
  const auto value = static_cast<double>(k);
  const auto fill = [&](SignalKind kind, double all) {
    frame[kind].values.setConstant(all);
    std::fill(frame[kind].quality.begin(), frame[kind].quality.end(), Quality::kGood);
  };
  fill(SignalKind::kCv, value);
  fill(SignalKind::kMv, 10.0 * value);
  fill(SignalKind::kDv, 100.0 * value);
  return frame;
}

}  // namespace mpm::test
