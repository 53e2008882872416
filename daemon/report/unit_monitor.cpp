#include "daemon/report/unit_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/archive/archive.hpp"
#include "core/statistics/normal.hpp"

namespace mpm::report {
namespace {

// Beyond these the data do not resolve a number, or the errors are no longer those of small steps
// that are estimated: a factor of 10 of the time constants, an interval of a factor of 5 either
// way, one of the dead time that is wider than it and a few samples.
constexpr double kMostLogTime = 2.3, kWidestLogTime = 1.6, kWidestDeadTimeSamples = 5.0;

// What no dead time allows is not in the interval.
void fill_errors(const ChannelStatus& status, double sample_time_s, ChannelRecord& record) {
  const auto half = [](const Estimate& estimate) { return kNormalTwoSided95 * estimate.deviation; };
  constexpr double kUnresolved = std::numeric_limits<double>::quiet_NaN();
  record.time_constant_ratio = record.time_constant_low = record.time_constant_high = kUnresolved;
  const Estimate& time = status.log_time_error;
  if (std::abs(time.value) <= kMostLogTime && half(time) <= kWidestLogTime) {
    record.time_constant_ratio = std::exp(time.value);
    record.time_constant_low = std::exp(time.value - half(time));
    record.time_constant_high = std::exp(time.value + half(time));
  }
  record.dead_time_error_s = record.dead_time_low_s = record.dead_time_high_s = kUnresolved;
  const Estimate& dead = status.dead_time_error;
  const double widest = status.dead_time + kWidestDeadTimeSamples;
  if (half(dead) <= widest && std::abs(dead.value) <= 2.0 * widest) {
    const auto seconds = [&](double samples) {
      return std::max(samples, -status.dead_time) * sample_time_s;
    };
    record.dead_time_error_s = seconds(dead.value);
    record.dead_time_low_s = seconds(dead.value - half(dead));
    record.dead_time_high_s = seconds(dead.value + half(dead));
  }
}

// A CV that begins anew with its alarm has no evidence of its own: the alarm carries what raised
// it.
AlarmRecord alarm_of(const ChannelRecord& channel, const AlarmTransition& transition) {
  const AlarmState to = transition.to;
  AlarmRecord alarm;
  static_cast<AlarmEvidence&>(alarm) = channel;
  if (channel.reason == Reason::kIsolating && channel.statistic == 0.0) {
    static_cast<AlarmEvidence&>(alarm) = transition.before;
    alarm.partial_correlation = channel.partial_correlation;
    alarm.lag = channel.lag;
  }
  alarm.unit = channel.unit;
  alarm.mv = channel.mv;
  alarm.cv = channel.cv;
  alarm.interval = channel.interval;
  alarm.source_time_ns = channel.source_time_ns;
  alarm.to = to == AlarmState::kActive ? AlarmChange::kActive : AlarmChange::kCleared;
  return alarm;
}

}  // namespace

std::vector<bool> predictions_of(const config::UnitConfig& config) {
  std::vector<bool> given;
  for (const config::CvSignal& cv : config.cv) given.push_back(!cv.prediction.empty());
  return given;
}

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
  tell_alarms();
}

void UnitMonitor::archive(Archive& a) {
  // not archived: config_ (construction)
  // not archived: filled_, channels_, alarms_ (what the monitor says)
  a(monitor_, interval_);
  a.time(source_time_ns_);
  if (!a.reads()) return;
  filled_ = false;
  tell_alarms();
}

void UnitMonitor::stand(std::size_t channel) {
  const int cvs = config_.counts().cv, place = static_cast<int>(channel);
  monitor_.stand(place % cvs, place / cvs);
  filled_ = false;
}

void UnitMonitor::tell_alarms() {
  alarms_.clear();
  if (monitor_.transitions().empty()) return;
  const int cvs = config_.counts().cv;
  for (const AlarmTransition& transition : monitor_.transitions())
    alarms_.push_back(alarm_of(
        channels()[static_cast<std::size_t>(transition.input * cvs + transition.cv)], transition));
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
      static_cast<ChannelVerdict&>(record) = status;
      record.confounder = status.confounder < 0 ? "" : config_.mover_tag(status.confounder);
      fill_errors(status, config_.model.sample_time_s, record);
      record.alarm = monitor_.alarm(j, i);
      record.nonlinear = monitor_.nonlinearity(j, i);
      const Eigen::Ref<const Eigen::VectorXd> values = monitor_.partial_correlations(j, i);
      for (Eigen::Index l = 0; l < values.size(); ++l)
        record.partial_correlations[static_cast<std::size_t>(l)] = values(l);
    }
  }
}

}  // namespace mpm::report
