#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/alarm/condition.hpp"
#include "core/mismatch/verdict.hpp"
#include "sim/loop/closed_loop.hpp"
#include "tests/study/experiment.hpp"

namespace mpm::study {

/// What is true of a channel at a time.
enum class Truth : std::uint8_t {
  kHealthy,   ///< equals the model, and always has
  kWrong,     ///< differs from it
  kSmall,     ///< differs by less than matters (Experiment::material)
  kReturned,  ///< equals the model again
};

/// A channel's truth over time.
class Timeline {
 public:
  void add(std::int64_t from, Truth truth) { parts_.push_back({from, truth}); }
  [[nodiscard]] Truth at(std::int64_t sample) const;
  /// Sample from which on the channel is first `truth`; nothing if it never is.
  [[nodiscard]] std::optional<std::int64_t> first(Truth truth) const;

 private:
  struct Part {
    std::int64_t from;
    Truth truth;
  };
  std::vector<Part> parts_;  // in order of time
};

struct ChannelReading {
  Truth truth = Truth::kHealthy;
  Verdict verdict = Verdict::kUndetermined;
  Reason reason = Reason::kWarmingUp;
  double p_value = 1.0;
  double statistic = 0.0;
  bool in_alarm = false;
};

struct AlarmChange {
  std::int64_t sample = 0;
  int channel = 0;
  AlarmState to = AlarmState::kCleared;
  Truth truth = Truth::kHealthy;
};

/// p-values of healthy channels between one sample number and the next bin's, every kStride-th.
inline constexpr int kStride = 10;
inline constexpr std::array<double, 6> kTailLevels = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
inline constexpr std::array<std::int64_t, 4> kTailBins = {0, 800, 1500, 3000};
struct TailBin {
  std::int64_t evaluations = 0;
  std::array<std::int64_t, kTailLevels.size()> below{};
  std::int64_t mismatches = 0;
};

/// Everything that is kept of one run.
struct RunRecord {
  std::int64_t samples = 0;
  bool diverged = false;
  std::vector<Timeline> truth;                        ///< one per channel: input * CVs + CV
  std::vector<std::vector<ChannelReading>> readings;  ///< one per Experiment::also_at, then the end
  std::array<TailBin, kTailBins.size()> tail;
  std::vector<AlarmChange> alarms;
};

/// An experiment with its files read.
struct Prepared {
  Experiment experiment;
  sim::LoopSetup setup;  ///< of the first seed, without what is drawn
};

/// Reads the files and makes sure that the loop can bear the changes. The reason, where it cannot
/// be run, is in `why_not`.
[[nodiscard]] std::optional<Prepared> prepare(const Experiment& experiment, std::string& why_not);

/// One closed loop with its monitor. Depends on nothing but its arguments; adds to `progress`.
[[nodiscard]] RunRecord run_one(const Prepared& prepared, std::uint64_t seed,
                                std::atomic<std::int64_t>& progress);

}  // namespace mpm::study
