#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario_config.hpp"
#include "core/signal/frame.hpp"
#include "sim/loop/closed_loop.hpp"
#include "sim/signals/intervals.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

/// What one entry of `bad_data` did so far.
struct BadDataCount {
  std::int64_t samples = 0;   ///< values, rows or time stamps that it touched
  std::int64_t possible = 0;  ///< those that it could have touched
};

/// Stands between the loop and whoever reads its data and spoils what is reported, in this order:
/// clipping, spikes, frozen values, quality; then rows and time stamps. The loop sees nothing of
/// it. Every run / share samples hold one run, at a random place, so that the share is met; without
/// a run length each sample is drawn for itself. Each entry and signal has a stream of its own. No
/// allocation after construction.
class BadDataFilter {
 public:
  /// Simulates the run once where a clipping range follows from its share. Throws
  /// std::invalid_argument on tags that the unit does not have, and on clock steps without
  /// `setup.samples`.
  explicit BadDataFilter(const LoopSetup& setup);

  /// The frame as reported, or null where its row is absent; valid until the next call.
  [[nodiscard]] const Frame* apply(const Frame& frame);

  /// What the last frame's time stamp is off by.
  [[nodiscard]] double time_error_s() const { return time_error_s_; }
  /// One per entry of the scenario.
  [[nodiscard]] const std::vector<BadDataCount>& counts() const { return counts_; }
  /// Range of the entry's clipping for its n-th tag, and the times of its clock steps.
  struct Details {
    std::vector<double> low, high;
    std::vector<double> step_times_s;
  };
  [[nodiscard]] const std::vector<Details>& details() const { return details_; }

 private:
  struct Signal {
    SignalKind kind;
    int index;
  };
  /// Decides sample by sample.
  class Occasions {
   public:
    Occasions(double share, double run, RandomStream stream)
        : share_(share), run_(run), stream_(stream) {}
    [[nodiscard]] bool next();
    [[nodiscard]] RandomStream& stream() { return stream_; }

   private:
    double share_, run_;
    RandomStream stream_;
    double sample_ = 0.0, cycle_end_ = 0.0, run_start_ = 0.0;
  };
  struct Target {
    Signal signal;
    Occasions occasions;
    double low, high;   ///< clipping
    double size;        ///< of a spike
    double last = 0.0;  ///< reported before
    bool has_last = false;
  };
  struct ClockStep {
    std::int64_t interval;
    double size_s;
  };
  struct Entry {
    config::BadDataKind kind;
    IntervalRange range;
    double share;
    std::vector<Target> targets;
    std::vector<Occasions> row;  ///< one for gaps and jitter
    std::vector<ClockStep> steps;
  };
  void add_entry(const LoopSetup& setup, const config::BadData& bad);
  void find_ranges(const LoopSetup& setup);
  void spoil_values(Entry& entry, bool active, BadDataCount& count);
  [[nodiscard]] bool spoil(config::BadDataKind kind, Target& target, SignalBlock& block);
  /// True where the row is reported.
  [[nodiscard]] bool spoil_row(Entry& entry, bool active, BadDataCount& count);

  double sample_time_s_;
  std::vector<Entry> entries_;  ///< in the scenario's order
  std::vector<std::size_t> order_;
  std::vector<BadDataCount> counts_;
  std::vector<Details> details_;
  Frame reported_;
  double clock_s_ = 0.0, time_error_s_ = 0.0;
};

/// Tags whose quality the scenario makes uncertain, and which so need a quality column.
[[nodiscard]] std::vector<std::string> uncertain_tags(const config::ScenarioConfig& scenario);

}  // namespace mpm::sim
