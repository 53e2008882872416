#include "daemon/report/unit_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/statistics/normal.hpp"

namespace mpm::daemon {
namespace {

std::vector<bool> predictions_of(const config::UnitConfig& config) {
  std::vector<bool> given;
  for (const config::CvSignal& cv : config.cv) given.push_back(!cv.prediction.empty());
  return given;
}

// What is not known at all stays finite for readers.
constexpr double kWidest = 1e6;

void fill_sizes(const ChannelStatus& status, double sample_time_s, ChannelRecord& record) {
  record.effect_low = status.effect_low;
  record.effect_high = status.effect_high;
  record.model_gain = status.model_gain;
  record.p_value_material = status.p_value_material;
  record.material = status.material;
  record.usual = status.usual;
  const auto bounded = [](double value) { return std::clamp(value, -kWidest, kWidest); };
  const auto half = [&](const Estimate& estimate) {
    return std::min(kNormalTwoSided95 * estimate.deviation, std::log(kWidest));
  };
  const Estimate& time = status.log_time_error;
  record.time_constant_ratio = std::min(std::exp(time.value), kWidest);
  record.time_constant_low = std::exp(bounded(time.value - half(time)));
  record.time_constant_high = std::min(std::exp(time.value + half(time)), kWidest);
  const Estimate& dead = status.dead_time_error;
  const double dead_half = std::min(kNormalTwoSided95 * dead.deviation, kWidest);
  record.dead_time_error_s = bounded(dead.value) * sample_time_s;
  record.dead_time_low_s = bounded(dead.value - dead_half) * sample_time_s;
  record.dead_time_high_s = bounded(dead.value + dead_half) * sample_time_s;
}

}  // namespace

UnitMonitor::UnitMonitor(const config::UnitConfig& config)
    : config_(config),
      monitor_(config.model, config.counts(), predictions_of(config), config.monitor,
               config.alarms) {
  const SignalCounts counts = config.counts();
  for (int i = 0; i < counts.inputs(); ++i) {
    for (int j = 0; j < counts.cv; ++j) {
      ChannelRecord record;
      record.unit = config.unit;
      record.mv = config.input_tag(i);
      record.cv = config.cv[static_cast<std::size_t>(j)].tag;
      record.first_lag = monitor_.first_lag();
      record.partial_correlations.resize(
          static_cast<std::size_t>(monitor_.last_lag() - monitor_.first_lag() + 1));
      channels_.push_back(std::move(record));
    }
  }
}

void UnitMonitor::push(const Frame& frame) {
  monitor_.push(frame);
  interval_ = frame.interval;
  source_time_ns_ = frame.source_time_ns;
  filled_ = false;
  alarms_.clear();
  if (monitor_.transitions().empty()) return;
  const int cvs = config_.counts().cv;
  for (const AlarmTransition& transition : monitor_.transitions()) {
    const ChannelRecord& channel =
        channels()[static_cast<std::size_t>(transition.input * cvs + transition.cv)];
    alarms_.push_back({channel.unit, channel.mv, channel.cv, channel.interval,
                       channel.source_time_ns,
                       transition.to == AlarmState::kActive ? "active" : "cleared", channel.p_value,
                       channel.statistic, channel.threshold, channel.partial_correlation,
                       channel.lag, channel.effect_size});
  }
}

// Nobody reads all records of every frame of a recording.
void UnitMonitor::fill() {
  filled_ = true;
  monitor_.correlate();
  const SignalCounts counts = config_.counts();
  for (int i = 0; i < counts.inputs(); ++i) {
    for (int j = 0; j < counts.cv; ++j) {
      ChannelRecord& record = channels_[static_cast<std::size_t>(i * counts.cv + j)];
      const ChannelStatus& status = monitor_.channel(j, i);
      record.interval = interval_;
      record.source_time_ns = source_time_ns_;
      record.verdict = to_string(status.verdict);
      record.reason = status.verdict == Verdict::kUndetermined ? to_string(status.reason) : "";
      if (status.confounder >= 0) record.reason += " with " + config_.input_tag(status.confounder);
      record.p_value = status.p_value;
      record.statistic = status.statistic;
      record.threshold = status.threshold;
      record.partial_correlation = status.partial_correlation;
      record.lag = status.lag;
      record.excited = status.excited;
      record.effect_size = status.effect_size;
      record.smallest_error = status.smallest_error;
      fill_sizes(status, config_.model.sample_time_s, record);
      record.effective_samples = status.effective_samples;
      record.alarm_active = monitor_.alarm(j, i) == AlarmState::kActive;
      const Eigen::Ref<const Eigen::VectorXd> values = monitor_.partial_correlations(j, i);
      for (Eigen::Index l = 0; l < values.size(); ++l)
        record.partial_correlations[static_cast<std::size_t>(l)] = values(l);
    }
  }
}

}  // namespace mpm::daemon
