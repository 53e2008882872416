#include "daemon/history/trend/changes.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics/calibration.hpp"
#include "core/statistics/level_change.hpp"
#include "core/statistics/normal.hpp"
#include "daemon/history/trend/calibration.hpp"

namespace mpm::history {
namespace {

/// A series with the periods that its points are of.
struct Series {
  std::vector<LevelPoint> points;
  std::vector<std::size_t> periods;
  void add(const Trend& trend, std::size_t period, double value, double deviation) {
    points.push_back({static_cast<double>(trend.periods[period].index), value, deviation});
    periods.push_back(period);
  }
  [[nodiscard]] bool enough() const { return points.size() >= level_change::kFewestPoints; }
};

// Logarithms: errors are known to a share of their size.
Series errors_of(const Trend& trend, std::size_t cv) {
  Series series;
  for (std::size_t k = 0; k < trend.periods.size(); ++k) {
    const CvPeriod& period = trend.periods[k].cvs[cv];
    if (known(period.deviation) && period.prediction_rms > 0.0)
      series.add(trend, k, std::log(period.prediction_rms), period.deviation);
  }
  return series;
}

Series gains_of(const Trend& trend, std::size_t channel) {
  Series series;
  for (std::size_t k = 0; k < trend.periods.size(); ++k) {
    const ChannelPeriod& period = trend.periods[k].channels[channel];
    if (known(period.gain_error)) series.add(trend, k, period.gain_error, period.deviation);
  }
  return series;
}

// The first period that differs.
std::size_t first_of(const Series& series, const LevelChange& change) {
  return series.periods[change.first + (change.gradual ? 1 : 0)];
}

// Root mean square of the movement in periods from `first` to before `end`.
double movement(const Trend& trend, const Series& series, std::size_t cv, std::size_t first,
                std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = first; i < end; ++i)
    sum += std::pow(trend.periods[series.periods[i]].cvs[cv].movement_rms, 2.0);
  return std::sqrt(sum / static_cast<double>(end - first));
}

std::optional<Change> change_of_errors(const Trend& trend, std::size_t cv, const Series& series,
                                       double level) {
  const std::optional<LevelChange> found = find_level_change(series.points);
  if (!found || found->p_value > level) return std::nullopt;
  const double step = found->after - found->before;
  if (std::abs(step) < std::log(kLeastRatio)) return std::nullopt;
  Change change;
  change.cv = trend.head.cvs[cv].cv;
  change.gradual = found->gradual;
  change.first = first_of(series, *found);
  change.before = 1.0;
  change.now = std::exp(step);
  change.low = std::exp(step - kNormalTwoSided95 * found->deviation);
  change.high = std::exp(step + kNormalTwoSided95 * found->deviation);
  change.p_value = found->p_value;
  const std::size_t begun = found->first + (found->gradual ? 1 : 0);
  change.movement_ratio = movement(trend, series, cv, begun, series.points.size()) /
                          movement(trend, series, cv, 0, begun);
  return change;
}

// Of the channel, in the period at which it changed or beside it.
std::optional<std::int64_t> alarm_about(const Trend& trend, const Change& change) {
  const Period& first = trend.periods[change.first - std::min<std::size_t>(1, change.first)];
  const Period& last = trend.periods[std::min(change.first + 1, trend.periods.size() - 1)];
  for (const AlarmChangeNote& alarm : trend.alarms)
    if (alarm.active && alarm.mv == change.mv && alarm.cv == change.cv &&
        alarm.time_ns >= first.from_ns && alarm.time_ns <= last.until_ns)
      return alarm.time_ns;
  return std::nullopt;
}

std::optional<Change> change_of_gain(const Trend& trend, std::size_t channel, const Series& series,
                                     double level) {
  const std::optional<LevelChange> found = find_level_change(series.points);
  if (!found || found->p_value > level) return std::nullopt;
  const ChannelHead& head = trend.head.channels[channel];
  const double matters = head.modelled ? 100.0 * head.gain_limit : 0.0;
  if (std::abs(found->after - found->before) < matters) return std::nullopt;
  const ChannelPeriod& last = trend.periods[series.periods.back()].channels[channel];
  Change change{head.mv,   head.cv,       found->gradual,  series.periods[found->first],
                {},        found->before, last.gain_error, last.low,
                last.high, 1.0,           found->p_value};
  if (!change.gradual) change.alarm_ns = alarm_about(trend, change);
  return change;
}

bool told(const Findings& findings, const ChannelDigest& channel) {
  return std::any_of(findings.changes.begin(), findings.changes.end(), [&](const Change& change) {
    return change.mv == channel.mv && change.cv == channel.cv;
  });
}

void add_standing(const Trend& trend, Findings& findings) {
  for (const ChannelDigest& channel : trend.last) {
    if (channel.alarm != "active" || told(findings, channel)) continue;
    Standing standing{channel.mv, channel.cv, {}, channel.gain_error, channel.low, channel.high};
    for (const AlarmChangeNote& alarm : trend.alarms)
      if (alarm.active && alarm.mv == channel.mv && alarm.cv == channel.cv)
        standing.since_ns = alarm.time_ns;
    findings.standing.push_back(std::move(standing));
  }
}

void add_silences(const Trend& trend, Findings& findings) {
  for (std::size_t c = 0; c < trend.head.channels.size(); ++c) {
    std::size_t spoke = trend.periods.size();  // periods up to the last that is known
    while (spoke > 0 && !known(trend.periods[spoke - 1].channels[c].gain_error)) --spoke;
    if (spoke == trend.periods.size()) continue;
    // The last period may have just begun.
    if (spoke + 1 == trend.periods.size() && trend.last[c].verdict != "undetermined") continue;
    Silence silence;
    silence.last = trend.last[c];
    if (spoke > 0) silence.since = spoke;
    findings.silent.push_back(std::move(silence));
  }
}

}  // namespace

Findings find_changes(const Trend& trend) {
  std::vector<Series> errors, gains;
  for (std::size_t j = 0; j < trend.head.cvs.size(); ++j) errors.push_back(errors_of(trend, j));
  for (std::size_t c = 0; c < trend.head.channels.size(); ++c) gains.push_back(gains_of(trend, c));
  Findings findings;
  for (const std::vector<Series>* all : {&errors, &gains})
    for (const Series& series : *all) findings.asked += series.enough() ? 1 : 0;
  const double level = kFalseRate / static_cast<double>(std::max<std::size_t>(1, findings.asked));
  for (std::size_t j = 0; j < errors.size(); ++j)
    if (std::optional<Change> change = change_of_errors(trend, j, errors[j], level))
      findings.changes.push_back(std::move(*change));
  for (std::size_t c = 0; c < gains.size(); ++c)
    if (std::optional<Change> change = change_of_gain(trend, c, gains[c], level))
      findings.changes.push_back(std::move(*change));
  add_standing(trend, findings);
  add_silences(trend, findings);
  return findings;
}

}  // namespace mpm::history
