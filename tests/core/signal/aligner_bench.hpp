#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/signal/aligner.hpp"

/// An aligner of three kinds, and what came out of it.
namespace mpm::test {

inline constexpr SignalCounts kCounts{2, 0, 1, 0};

constexpr std::array<bool, kSignalKindCount> needed_kinds() {
  std::array<bool, kSignalKindCount> needed{};
  needed[static_cast<std::size_t>(SignalKind::kMv)] = true;
  needed[static_cast<std::size_t>(SignalKind::kCv)] = true;
  needed[static_cast<std::size_t>(SignalKind::kPrediction)] = true;
  return needed;
}

inline constexpr std::array kKinds = {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction};

struct Seen {
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::vector<double> values;  // of all blocks; NaN where not usable
  bool operator==(const Seen& other) const {
    return interval == other.interval && source_time_ns == other.source_time_ns &&
           std::equal(values.begin(), values.end(), other.values.begin(), other.values.end(),
                      [](double a, double b) { return a == b || (a != a && b != b); });
  }
};

struct AlignerBench {
  std::vector<Seen> frames;
  Aligner aligner;
  std::int64_t clock_ns = 0;  // what source times have beyond those that go with the numbers

  explicit AlignerBench(const AlignerSettings& settings = {})
      : aligner(
            kCounts, needed_kinds(), [this](const Frame& frame) { record(frame); }, settings) {}

  void record(const Frame& frame) {
    Seen seen{frame.interval, frame.source_time_ns, {}};
    for (const SignalBlock& block : frame.blocks)
      for (int i = 0; i < block.size(); ++i)
        seen.values.push_back(block.usable(i) ? block.values(i)
                                              : std::numeric_limits<double>::quiet_NaN());
    frames.push_back(seen);
  }

  void push(SignalKind kind, std::int64_t interval, double shift = 0.0) {
    const double base = 10.0 * static_cast<double>(interval) + static_cast<double>(kind) + shift;
    const std::array<double, 2> values = {base, base + 0.5};
    aligner.push({kind,
                  interval,
                  interval * 1000 + clock_ns,
                  std::span(values).first(static_cast<std::size_t>(kCounts.of(kind))),
                  {}});
  }
  void push_all(std::int64_t first, std::int64_t last) {
    for (std::int64_t k = first; k <= last; ++k)
      for (const SignalKind kind : kKinds) push(kind, k);
  }
  [[nodiscard]] std::vector<std::int64_t> intervals() const {
    std::vector<std::int64_t> result;
    for (const Seen& seen : frames) result.push_back(seen.interval);
    return result;
  }
};

inline std::vector<std::int64_t> range(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> result;
  for (std::int64_t k = first; k <= last; ++k) result.push_back(k);
  return result;
}

struct Block {
  SignalKind kind;
  std::int64_t interval;
};

}  // namespace mpm::test
