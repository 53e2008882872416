#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// What the monitor says, as records with tags instead of indices. The DDS output topics, the
/// JSON lines of daemon and `mpm detect`, and `mpm watch` all carry these, so one serialiser makes
/// them byte-identical.
namespace mpm::report {

/// One channel after one sample; topic mpm/channel_status.
struct ChannelRecord {
  std::string unit, mv, cv;  ///< tags; `mv` may be a DV's
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::string verdict;  ///< match | mismatch | undetermined
  std::string reason;   ///< empty unless undetermined
  double p_value = 1.0;
  double statistic = 0.0;
  double threshold = 0.0;
  double partial_correlation = 0.0;
  int lag = 0;  ///< samples
  bool excited = false;
  double effect_size = 0.0;  ///< CV units per input unit
  double effect_low = 0.0;   ///< its 95 % interval
  double effect_high = 0.0;
  double model_gain = 0.0;  ///< what 100 % means, CV units per input unit
  double p_value_material = 1.0;
  bool material = false;  ///< the error is beyond the materiality limits
  bool usual = false;     ///< gain, time constant and dead time explain what is seen
  double time_constant_ratio = 1.0, time_constant_low = 1.0, time_constant_high = 1.0;
  double dead_time_error_s = 0.0, dead_time_low_s = 0.0, dead_time_high_s = 0.0;
  double smallest_error = 0.0;  ///< relative gain error
  double effective_samples = 0.0;
  bool alarm_active = false;
  int first_lag = 0;
  std::vector<double> partial_correlations;  ///< lags first_lag, first_lag + 1, ...
};

/// A fitted number with its 95 % interval; names and units as in report.json.
struct CauseParameter {
  std::string name;
  double value = 0.0, low = 0.0, high = 0.0;
};

/// What a diagnosis says of an alarm.
struct NamedCause {
  std::string cause;  ///< as in report.json; empty where none is named
  std::string text;   ///< the same for a person; empty before the first diagnosis
  double confidence = 0.0;
  std::vector<CauseParameter> parameters;
};

/// A channel's alarm changed; topics mpm/alarm (latest) and mpm/alarm_event (each).
struct AlarmRecord {
  std::string unit, mv, cv;
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::string to;  ///< active | cleared | diagnosed: still active, with a cause
  double p_value = 1.0;
  double statistic = 0.0;
  double threshold = 0.0;
  double partial_correlation = 0.0;
  int lag = 0;
  double effect_size = 0.0;
  NamedCause named = {};
};

[[nodiscard]] nlohmann::ordered_json to_json(const ChannelRecord& record);
/// `record` is "diagnosis" where it was diagnosed, else "alarm": the alarms of a journal and of
/// `mpm watch` are the same lines, whether or not somebody had time for a diagnosis.
[[nodiscard]] nlohmann::ordered_json to_json(const AlarmRecord& record);

}  // namespace mpm::report
