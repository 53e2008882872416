#include "core/monitor/derived_settings.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

// Effective samples, (1 + lambda) / (1 - lambda), of the default memory.
constexpr double kEffectiveSamples = 4000.0;
constexpr double kFastEffectiveSamples = 1000.0;

// An evaluation costs as much as several rows and what it says changes slowly: for 88 columns every
// eighth sample.
constexpr double kColumnsPerStride = 11.0;
constexpr int kLongestStride = 30;

// An error in the dead time must stay inside the pulse lags: this many samples beyond the longest.
constexpr int kDeadTimeMargin = 13;
constexpr int kFewestFirLags = 20;
constexpr int kMostFirLags = 60;

constexpr int kResidualOrder = 8;

// Slowest time constants after which what a wrong start left behind is below 1 %.
constexpr double kSettlingTimeConstants = 5.0;

int samples(double seconds, double sample_time_s, int otherwise) {
  return seconds > 0.0 ? std::max(1, static_cast<int>(std::lround(seconds / sample_time_s)))
                       : otherwise;
}

// lambda whose (1 + lambda) / (1 - lambda) is that many.
double forgetting(double effective_samples) {
  return (effective_samples - 1.0) / (effective_samples + 1.0);
}

// Memories of fewer rows than these per column could hardly tell the columns apart.
constexpr double kLongRowsPerColumn = 15.0;
constexpr double kFastRowsPerColumn = 8.0;

void derive_memories(const ModelSpec& spec, const MonitorSettings& monitor,
                     DerivedSettings& derived) {
  const double columns =
      1.0 + spec.cv_count * derived.residual_order +
      spec.input_count * (derived.fir_lags + static_cast<double>(derived.tail_poles.size()));
  const auto effective = [&](double memory_s, double otherwise, double rows_per_column) {
    const double wanted = memory_s > 0.0 ? 2.0 * memory_s / spec.sample_time_s : otherwise;
    return std::max(wanted, rows_per_column * columns);
  };
  const double lasting = effective(monitor.memory_s, kEffectiveSamples, kLongRowsPerColumn);
  const double fast = effective(monitor.fast_memory_s, kFastEffectiveSamples, kFastRowsPerColumn);
  derived.lambda = forgetting(lasting);
  if (monitor.sliding_window)
    derived.memories.push_back({1.0, static_cast<int>(lasting)});
  else
    derived.memories.push_back({derived.lambda, 0});
  if (fast < lasting) derived.memories.push_back({forgetting(fast), 0});
  derived.remembered = static_cast<int>(std::ceil(1.2 * lasting));
  derived.evaluation_stride =
      std::clamp(static_cast<int>(columns / kColumnsPerStride), 1, kLongestStride);
}

void derive_materiality(const ModelSpec& spec, const MonitorSettings& monitor,
                        DerivedSettings& derived) {
  derived.materiality.assign(static_cast<std::size_t>(spec.input_count * spec.cv_count),
                             monitor.materiality);
  for (const ChannelLimits& channel : monitor.channel_materiality)
    derived.materiality[static_cast<std::size_t>(channel.input * spec.cv_count + channel.cv)] =
        channel.limits;
}

}  // namespace

DerivedSettings derive_settings(const ModelSpec& spec, const LinearModel& model,
                                const MonitorSettings& monitor, const AlarmSettings& alarms) {
  const double sample_time_s = spec.sample_time_s;
  const double slowest = std::max(model.slowest_time_constant_samples(), 1.0);
  const double dead_time = model.longest_dead_time_samples();

  DerivedSettings derived;
  derived.false_alarm_rate = monitor.false_alarm_rate;
  derived.gain_error_of_interest = monitor.gain_error_of_interest;
  derived.correlation = monitor.correlation;
  derived.threshold = monitor.threshold;
  derived.controlling_lags = monitor.controlling_lags;
  derived.first_lag = monitor.first_lag;
  derived.last_lag = monitor.last_lag;
  derived.fir_lags = monitor.fir_lags > 0
                         ? monitor.fir_lags
                         : std::clamp(static_cast<int>(std::ceil(dead_time)) + kDeadTimeMargin,
                                      kFewestFirLags, kMostFirLags);
  derived.residual_order = monitor.residual_order > 0 ? monitor.residual_order : kResidualOrder;

  // One tail with the slowest time constant, and further ones, each four times faster, as long as
  // they are slower than the pulse lags can show.
  double tail = monitor.tail_s > 0.0 ? monitor.tail_s / sample_time_s : slowest;
  do {
    derived.tail_poles.push_back(std::exp(-1.0 / tail));
    tail /= 4.0;
  } while (tail >= 2.0 * derived.fir_lags);

  derive_memories(spec, monitor, derived);

  derive_materiality(spec, monitor, derived);
  derived.settling_samples =
      static_cast<int>(std::ceil(kSettlingTimeConstants * slowest + dead_time));
  derived.alarm.raise_below = alarms.raise_p_value;
  derived.alarm.clear_above = alarms.clear_p_value;
  derived.alarm.on_delay = samples(alarms.on_delay_s, sample_time_s, 10);
  derived.alarm.off_delay = samples(alarms.off_delay_s, sample_time_s, 60);
  return derived;
}

}  // namespace mpm
