#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/alarm/condition.hpp"
#include "core/mismatch/verdict.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"
#include "core/record/field_key.hpp"

namespace mpm {

/// One channel after one sample, with tags instead of indices; topic mpm/channel_status.
struct ChannelRecord : ChannelVerdict {
  std::string unit, mv, cv;  ///< tags; `mv` may be a DV's
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::string confounder;  ///< tag of the other signal that the reason names, else empty
  /// Where the data do not resolve them NaN, as on the topic.
  double time_constant_ratio = 1.0, time_constant_low = 1.0, time_constant_high = 1.0;
  double dead_time_error_s = 0.0, dead_time_low_s = 0.0, dead_time_high_s = 0.0;
  AlarmState alarm = AlarmState::kCleared;
  ChannelNonlinearity nonlinear;
  int first_lag = 0;
  std::vector<double> partial_correlations;  ///< lags first_lag, first_lag + 1, ...

  /// An effect in per cent of the model's gain and in its direction, where it is not 0.
  [[nodiscard]] double percent_of_gain(double effect) const {
    return 100.0 * (model_gain < 0.0 ? -effect : effect) / std::abs(model_gain);
  }

  /// Whether the data resolve the gain: its 95 % interval is no wider than +-100 % of the model's.
  [[nodiscard]] bool gain_resolved() const {
    return model_gain != 0.0 && std::abs(effect_high - effect_low) <= 2.0 * std::abs(model_gain);
  }
  [[nodiscard]] bool time_constant_resolved() const {
    return usual && std::isfinite(time_constant_ratio);
  }
  [[nodiscard]] bool dead_time_resolved() const {
    return usual && std::isfinite(dead_time_error_s);
  }

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    const bool has_gain = record.gain_resolved();
    const std::array ends{record.percent_of_gain(record.effect_low),
                          record.percent_of_gain(record.effect_high)};
    visit("record", std::string_view("channel"));
    visit("unit", record.unit, sample.unit...);
    visit("interval", record.interval, sample.interval...);
    visit("time_ns", record.source_time_ns, sample.source_time_ns...);
    visit("mv", record.mv, sample.mv...);
    visit("cv", record.cv, sample.cv...);
    visit("verdict", record.verdict, sample.verdict...);
    visit({"reason", record.reason != Reason::kNone}, std::tie(record.reason, record.confounder),
          sample.reason...);
    visit("p_value", record.p_value, sample.p_value...);
    visit("statistic", record.statistic, sample.statistic...);
    visit("threshold", record.threshold, sample.threshold...);
    visit("partial_correlation", record.partial_correlation, sample.partial_correlation...);
    visit("lag", record.lag, sample.lag...);
    visit("excited", record.excited, sample.excited...);
    visit("p_value_material", record.p_value_material, sample.p_value_material...);
    visit("material", record.material, sample.material...);
    visit("effect_size", record.effect_size, sample.effect_size...);
    visit("effect_interval", std::tie(record.effect_low, record.effect_high),
          std::tie(sample.effect_low, sample.effect_high)...);
    visit("model_gain", record.model_gain, sample.model_gain...);
    visit({"gain_error_percent", has_gain}, record.percent_of_gain(record.effect_size));
    visit({"gain_error_percent_interval", has_gain},
          std::array{std::min(ends[0], ends[1]), std::max(ends[0], ends[1])});
    visit({"usual", false}, record.usual, sample.usual...);
    visit({"time_constant_ratio", record.time_constant_resolved()}, record.time_constant_ratio,
          sample.time_constant_ratio...);
    visit({"time_constant_ratio_interval", record.time_constant_resolved()},
          std::tie(record.time_constant_low, record.time_constant_high),
          std::tie(sample.time_constant_low, sample.time_constant_high)...);
    visit({"dead_time_error", record.dead_time_resolved()}, record.dead_time_error_s,
          sample.dead_time_error...);
    visit({"dead_time_error_interval", record.dead_time_resolved()},
          std::tie(record.dead_time_low_s, record.dead_time_high_s),
          std::tie(sample.dead_time_low, sample.dead_time_high)...);
    visit("smallest_error", record.smallest_error, sample.smallest_error...);
    visit("effective_samples", record.effective_samples, sample.effective_samples...);
    visit("alarm", record.alarm, sample.alarm_active...);
    visit({"gain_variation", std::isfinite(record.gain_variation)}, record.gain_variation,
          sample.gain_variation...);
    visit({"nonlinear", record.nonlinear.tested}, record.nonlinear, sample.nonlinear...);
    visit("partial_correlations", std::tie(record.first_lag, record.partial_correlations),
          std::tie(sample.first_lag, sample.partial_correlations)...);
  }
};

}  // namespace mpm
