#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/study/interval.hpp"
#include "tests/study/run.hpp"

namespace mpm::study {

/// One share, as of sample `at` (0 = over the whole run). Names, "healthy" and "wrong" being
/// channels by their truth at that time:
///
///     healthy_p_0.05 .. healthy_p_0.0001   healthy channels with a smaller p-value
///     healthy_VERDICT, wrong_VERDICT       match, mismatch, or the reason for undetermined
///     family_p                             runs with a healthy channel's p < 0.01 / channels
///     false_mismatch_runs                  runs with a mismatch on a healthy channel
///     ranked                               runs whose wrong channels have the smallest p-values
///     small_mismatch                       channels wrong by less than matters, called mismatch
///     tail_LEVEL, tail_LEVEL_from_SAMPLE   evaluations of healthy channels with a smaller p-value
///     tail_mismatch                        evaluations with a mismatch on a healthy channel
///     alarmed                              runs with an alarm on a wrong channel
///     alarmed_channels                     wrong channels that were in alarm while wrong
///     first_alarm_right                    runs with an alarm, whose first one is on a wrong
///     channel alarms_right                         alarms on wrong channels among these and false
///     ones false_alarm_runs                     runs with an alarm on a healthy channel
///     healthy_in_alarm                     healthy channels in alarm at the end
///     cleared_after_return                 channels in alarm when they returned or later, that are
///                                          not at the end
struct Metric {
  std::string name;
  int at = 0;
  Share share;
};

struct Quartiles {
  std::int64_t count = 0;
  double first = 0.0, median = 0.0, third = 0.0;  ///< infinite = did not happen
};

struct Summary {
  Experiment experiment;
  std::int64_t runs = 0;
  std::int64_t diverged = 0;  ///< of the runs; they count nowhere else
  int channels = 0;
  std::int64_t samples = 0;  ///< pushed
  double wall_s = 0.0;
  std::vector<Metric> metrics;
  Quartiles alarm_delay;  ///< samples from the onset to the first alarm on a wrong channel
  Quartiles clear_delay;  ///< samples from the return to the end of a channel's alarm
  std::int64_t right_alarms = 0, false_alarms = 0;
  std::int64_t alarms_after_return = 0;  ///< raised on channels that had returned
  Interval false_alarms_interval;        ///< of their expected number

  /// Nothing where it does not apply.
  [[nodiscard]] const Share* find(const std::string& name, int at = 0) const;
};

[[nodiscard]] Summary summarise(const Experiment& experiment, const std::vector<RunRecord>& runs);

/// Match, mismatch and the reasons for undetermined, as they stand in the names of metrics.
[[nodiscard]] const std::vector<std::string>& verdict_names();

/// What a bound says of a summary.
struct Finding {
  std::string text;
  bool kept = true;
};
/// A bound is broken where the count would be that far out with a probability below this, were the
/// true rate at the bound.
inline constexpr double kBrokenBelow = 1e-4;
[[nodiscard]] std::vector<Finding> check_bounds(const Summary& summary);

}  // namespace mpm::study
