#include "core/monitor/derived_settings.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/signature.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {
namespace {

namespace memories = calibration::memories;
namespace evaluation = calibration::evaluation;
namespace regression_shape = calibration::regression_shape;

int whole(double samples) { return static_cast<int>(std::min(samples, calibration::kMostSamples)); }

int samples(double seconds, double sample_time_s, int otherwise) {
  return seconds > 0.0 ? std::max(1, whole(std::round(seconds / sample_time_s))) : otherwise;
}

// lambda whose (1 + lambda) / (1 - lambda) is that many.
double forgetting(double effective_samples) {
  return (effective_samples - 1.0) / (effective_samples + 1.0);
}

// Lags until every swing that matters has ended: a pulse response's next change of sign.
int swinging_lags(const ModelSpec& spec, const LinearModel& model) {
  int lags = 0;
  for (int cv = 0; cv < spec.cv_count; ++cv) {
    for (int input = 0; input < spec.input_count; ++input) {
      const Eigen::VectorXd pulse =
          model.impulse_response(cv, input, 2 * regression_shape::kMostFirLags);
      const double matters = regression_shape::kSwingThatMatters * pulse.cwiseAbs().maxCoeff();
      double swing = 0.0;  // the farthest since the last change of sign
      for (int l = 1; l < static_cast<int>(pulse.size()); ++l) {
        if (swing * pulse(l) < 0.0) {
          if (std::abs(swing) > matters) lags = std::max(lags, l);
          swing = 0.0;
        }
        if (std::abs(pulse(l)) > std::abs(swing)) swing = pulse(l);
      }
    }
  }
  return lags;
}

void derive_memories(const ModelSpec& spec, const MonitorSettings& monitor,
                     DerivedSettings& derived) {
  const double columns =
      1.0 + spec.cv_count * derived.residual_order +
      static_cast<double>(derived.residual_poles.size()) +
      spec.input_count * (derived.fir_lags + static_cast<double>(derived.tail_poles.size()));
  const auto effective = [&](double memory_s, double otherwise, double rows_per_column) {
    const double wanted = memory_s > 0.0 ? 2.0 * memory_s / spec.sample_time_s : otherwise;
    return std::max(wanted, rows_per_column * columns);
  };
  const double lasting =
      effective(monitor.memory_s, memories::kEffectiveSamples, memories::kRowsPerColumn);
  const double fast = effective(monitor.fast_memory_s, memories::kFastEffectiveSamples,
                                memories::kFastRowsPerColumn);
  derived.lambda = forgetting(lasting);
  derived.ranked = whole(std::min(lasting, calibration::correlations::kMostRanked));
  if (monitor.sliding_window)
    derived.memories.push_back({1.0, whole(lasting)});
  else
    derived.memories.push_back({derived.lambda, 0});
  if (fast < lasting) derived.memories.push_back({forgetting(fast), 0});
  derived.remembered = whole(std::ceil(memories::kRememberedShare * lasting));
  derived.evaluation_stride = std::clamp(static_cast<int>(columns / evaluation::kColumnsPerStride),
                                         1, evaluation::kLongestStride);
  const double lags = derived.fir_lags + BlockBasis::lags_beyond(derived.tail_poles);
  derived.evaluation_stride =
      std::max(derived.evaluation_stride, static_cast<int>(lags / evaluation::kLagsPerStride));
}

void derive_materiality(const ModelSpec& spec, const LinearModel& model,
                        const MonitorSettings& monitor, DerivedSettings& derived) {
  const auto limits = [&](const MaterialitySettings& settings) {
    return MaterialityLimits{settings.gain, settings.time_constant,
                             settings.dead_time_s > 0.0
                                 ? settings.dead_time_s / spec.sample_time_s
                                 : calibration::materiality::kDeadTimeSamples,
                             settings.step_response};
  };
  derived.materiality.assign(static_cast<std::size_t>(spec.input_count * spec.cv_count),
                             limits(monitor.materiality));
  for (const ChannelMateriality& channel : monitor.channel_materiality)
    derived.materiality[static_cast<std::size_t>(channel.input * spec.cv_count + channel.cv)] =
        limits(channel.limits);
  // Unless the user sets it, a dead time has a share of the time constant; and a time constant is
  // known no better than half a sample, or the dead time that the user sets.
  std::vector<bool> set(derived.materiality.size(), monitor.materiality.dead_time_s > 0.0);
  for (const ChannelMateriality& channel : monitor.channel_materiality)
    set[static_cast<std::size_t>(channel.input * spec.cv_count + channel.cv)] =
        channel.limits.dead_time_s > 0.0;
  for (int i = 0; i < spec.input_count; ++i)
    for (int j = 0; j < spec.cv_count; ++j) {
      const auto at = static_cast<std::size_t>(i * spec.cv_count + j);
      MaterialityLimits& channel = derived.materiality[at];
      channel.time_constant = std::max(
          channel.time_constant, channel.dead_time_samples / model.time_constant_samples(j, i));
      if (!set[at])
        channel.dead_time_samples =
            std::max(channel.dead_time_samples,
                     calibration::materiality::kDeadTimeShare * model.time_constant_samples(j, i));
    }
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
  derived.nonlinear = monitor.nonlinear;
  derived.controlling_lags = monitor.controlling_lags;
  derived.first_lag = monitor.first_lag;
  derived.last_lag = monitor.last_lag;
  derived.fir_lags =
      monitor.fir_lags > 0
          ? monitor.fir_lags
          : std::clamp(std::max(whole(std::ceil(dead_time)) + regression_shape::kDeadTimeMargin,
                                swinging_lags(spec, model)),
                       regression_shape::kFewestFirLags, regression_shape::kMostFirLags);
  derived.residual_order =
      monitor.residual_order > 0 ? monitor.residual_order : regression_shape::kResidualOrder;
  for (const double mean : regression_shape::kResidualMeans)
    derived.residual_poles.push_back(std::exp(-1.0 / mean));

  double tail = monitor.tail_s > 0.0 ? monitor.tail_s / sample_time_s : slowest;
  double mean = tail;
  while (mean > 1.0) {
    derived.outside_poles.push_back(std::exp(-1.0 / mean));
    mean /= calibration::confounding::kPoleRatio;
  }
  do {
    derived.tail_poles.push_back(std::exp(-1.0 / tail));
    tail /= regression_shape::kTailRatio;
  } while (tail >= regression_shape::kSlowerThanLags * derived.fir_lags);

  derive_memories(spec, monitor, derived);

  derive_materiality(spec, model, monitor, derived);
  // What takes longer to decay than is remembered is as good as constant there.
  const double remembered = derived.remembered;
  derived.settling_samples = whole(std::ceil(
      std::min(calibration::simulation::kSettlingTimeConstants * slowest, remembered) + dead_time));
  derived.starting_samples =
      whole(std::ceil(std::min(calibration::simulation::kStartingTimeConstants * slowest,
                               calibration::simulation::kLongestStartingShare * remembered) +
                      dead_time));
  for (const double share : calibration::simulation::kStartPoles)
    derived.start_poles.push_back(std::exp(-1.0 / (share * slowest)));
  derived.alarm.raise_below = alarms.raise_p_value;
  derived.alarm.clear_above = alarms.clear_p_value;
  derived.alarm.on_delay =
      samples(alarms.on_delay_s, sample_time_s, calibration::alarms::kOnDelaySamples);
  derived.alarm.off_delay =
      samples(alarms.off_delay_s, sample_time_s, calibration::alarms::kOffDelaySamples);
  return derived;
}

}  // namespace mpm
