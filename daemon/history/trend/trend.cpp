#include "daemon/history/trend/trend.hpp"

#include <algorithm>
#include <cmath>

#include "core/signal/nanoseconds.hpp"
#include "core/statistics/normal.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/history/trend/calibration.hpp"
#include "daemon/report/moment_text.hpp"

namespace mpm::history {
namespace {

constexpr std::int64_t kHour = 3600, kHoursPerDay = 24, kDaysPerWeek = 7;  // s, ...
constexpr std::int64_t kMondays = 3;  // 1 January 1970 was a Thursday
constexpr double kSecondsPerDay = 86400.0;

// Of an hour of the clock.
std::int64_t index_of(std::int64_t hour, Step step, bool dated) {
  if (step == Step::kHour) return hour;
  const std::int64_t day = floor_division(hour, kHoursPerDay);
  return step == Step::kDay ? day : floor_division(day + (dated ? kMondays : 0), kDaysPerWeek);
}

// Where a period begins, by the clock.
std::int64_t local_s(std::int64_t index, Step step, bool dated) {
  if (step == Step::kHour) return index * kHour;
  if (step == Step::kDay) return index * kHoursPerDay * kHour;
  return (index * kDaysPerWeek - (dated ? kMondays : 0)) * kHoursPerDay * kHour;
}

double seconds_of(Step step) {
  const auto hour = static_cast<double>(kHour);
  if (step == Step::kHour) return hour;
  return step == Step::kDay ? kSecondsPerDay : kDaysPerWeek * kSecondsPerDay;
}

double rms_of(double square, std::int64_t count) {
  return std::sqrt(square / static_cast<double>(count));
}

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::int64_t Trend::samples() const {
  std::int64_t sum = 0;
  for (const Period& period : periods) sum += period.samples;
  return sum;
}

bool Trend::mismatch() const {
  return std::any_of(last.begin(), last.end(),
                     [](const ChannelDigest& channel) { return channel.verdict == "mismatch"; });
}

void TrendMaker::CvSums::add(const CvSums& other) {
  samples += other.samples;
  pairs += other.pairs;
  residual += other.residual;
  prediction += other.prediction;
  movement += other.movement;
  fourth += other.fourth;
}

void TrendMaker::ChannelSums::add(const ChannelSums& other) {
  match += other.match;
  mismatch += other.mismatch;
  excited += other.excited;
  weight += other.weight;
  error += other.error;
  low += other.low;
  high += other.high;
  effective += other.effective;
}

void TrendMaker::Sums::add(const Sums& other) {
  from_ns = samples == 0 ? other.from_ns : std::min(from_ns, other.from_ns);
  until_ns = samples == 0 ? other.until_ns : std::max(until_ns, other.until_ns);
  samples += other.samples;
  for (const auto& [tag, sums] : other.cvs) cvs[tag].add(sums);
  for (const auto& [tags, sums] : other.channels) channels[tags].add(sums);
}

bool TrendMaker::is_new(const Digest& digest) {
  std::vector<double> key{static_cast<double>(digest.from_ns)};
  for (const CvDigest& cv : digest.cvs)
    key.push_back(known(cv.residual_rms) ? cv.residual_rms : -1.0);
  return seen_.insert(std::move(key)).second;
}

void TrendMaker::add(const Digest& digest) {
  if (!is_new(digest)) return;
  Sums sums;
  sums.from_ns = digest.from_ns;
  sums.until_ns = digest.until_ns;
  sums.samples = digest.samples;
  for (const CvDigest& cv : digest.cvs) {
    CvSums& of = sums.cvs[cv.cv];
    const auto square = [](double root, std::int64_t count) {
      return count > 0 ? root * root * static_cast<double>(count) : 0.0;
    };
    of.samples = cv.samples;
    of.pairs = cv.pairs;
    of.residual = square(cv.residual_rms, cv.samples);
    of.prediction = square(cv.prediction_rms, cv.pairs);
    of.movement = square(cv.movement_rms, cv.pairs);
    if (cv.pairs > 0) of.fourth = of.prediction * cv.prediction_rms * cv.prediction_rms;
  }
  for (const ChannelDigest& channel : digest.channels) {
    ChannelSums& of = sums.channels[{channel.mv, channel.cv}];
    of.match = channel.match;
    of.mismatch = channel.mismatch;
    of.excited = channel.excited;
    if (!known(channel.gain_error)) continue;
    of.weight = static_cast<double>(channel.match + channel.mismatch);
    of.error = of.weight * channel.gain_error;
    of.low = of.weight * channel.low;
    of.high = of.weight * channel.high;
    of.effective = of.weight * channel.effective_samples;
  }
  const std::int64_t utc_s = floor_division(digest.from_ns, kSecondNs);
  const std::int64_t east =
      zone_ != nullptr && report::is_date(digest.from_ns) ? zone_->offset_s(utc_s) : 0;
  hours_[floor_division(utc_s + east, kHour)].add(sums);
  last_ns_ = std::max(last_ns_, digest.until_ns);
  last_ = digest.channels;
}

Period TrendMaker::period_of(std::int64_t index, const Sums& sums, Step step) const {
  const double least = kLeastShare * seconds_of(step) / head_.sample_time_s;
  Period period{index, sums.from_ns, sums.until_ns, sums.samples, {}, {}};
  for (const CvHead& cv : head_.cvs) {
    CvPeriod& of = period.cvs.emplace_back();
    const auto found = sums.cvs.find(cv.cv);
    if (found == sums.cvs.end()) continue;
    const CvSums& sum = found->second;
    of.known = share(sum.samples, sums.samples);
    if (static_cast<double>(sum.pairs) < least || sum.pairs == 0) continue;
    of.residual_rms = rms_of(sum.residual, sum.samples);
    of.prediction_rms = rms_of(sum.prediction, sum.pairs);
    of.movement_rms = rms_of(sum.movement, sum.pairs);
    // Errors that overlap in time are one.
    const auto pairs = static_cast<double>(sum.pairs);
    const double apart =
        2.0 * static_cast<double>(head_.horizon_samples) + head_.digest_s / head_.sample_time_s;
    const double mean = sum.prediction / pairs;
    const double variance = std::max(0.0, sum.fourth / pairs - mean * mean);
    if (mean > 0.0) of.deviation = 0.5 * std::sqrt(variance * apart / pairs) / mean;
  }
  for (const ChannelHead& channel : head_.channels) {
    ChannelPeriod& of = period.channels.emplace_back();
    const auto found = sums.channels.find({channel.mv, channel.cv});
    const ChannelSums sum = found == sums.channels.end() ? ChannelSums() : found->second;
    of.match = share(sum.match, sums.samples);
    of.mismatch = share(sum.mismatch, sums.samples);
    of.undetermined = share(sums.samples - sum.match - sum.mismatch, sums.samples);
    of.excited = share(sum.excited, sums.samples);
    if (sum.weight < least || sum.weight == 0.0) continue;
    of.gain_error = sum.error / sum.weight;
    of.low = sum.low / sum.weight;
    of.high = sum.high / sum.weight;
    // Estimates within one memory are one.
    const double memories = sum.weight / (sum.effective / sum.weight);
    of.deviation = (of.high - of.low) / (2.0 * kNormalTwoSided95) / std::sqrt(memories);
  }
  return period;
}

Trend TrendMaker::finish() const {
  Trend trend;
  trend.head = head_;
  trend.dated = report::is_date(last_ns_);
  trend.alarms = alarms_;
  for (const ChannelHead& head : head_.channels) {
    ChannelDigest& last = trend.last.emplace_back();
    for (const ChannelDigest& channel : last_)
      if (channel.mv == head.mv && channel.cv == head.cv) last = channel;
    last.mv = head.mv;
    last.cv = head.cv;
  }
  if (hours_.empty()) return trend;
  const double days = static_cast<double>(last_ns_ - hours_.begin()->second.from_ns) /
                      static_cast<double>(kSecondNs) / kSecondsPerDay;
  const Step usual = days <= kHoursUpToDays  ? Step::kHour
                     : days <= kDaysUpToDays ? Step::kDay
                                             : Step::kWeek;
  trend.step = step_.value_or(usual);
  std::map<std::int64_t, Sums> periods;
  for (const auto& [hour, sums] : hours_)
    periods[index_of(hour, trend.step, trend.dated)].add(sums);
  for (const auto& [index, sums] : periods)
    trend.periods.push_back(period_of(index, sums, trend.step));
  return trend;
}

std::string period_name(const Trend& trend, std::size_t period) {
  const std::int64_t index = trend.periods[period].index;
  if (!trend.dated)
    return std::string(to_string(trend.step)) + " " +
           std::to_string(index - trend.periods.front().index + 1);
  const auto text = [&](std::int64_t of, const char* format) {
    return files::formatted_utc(local_s(of, trend.step, true), format);
  };
  const bool this_year = text(index, "%Y") == text(trend.periods.back().index, "%Y");
  const std::string year = this_year ? "" : text(index, " %Y");
  switch (trend.step) {
    case Step::kHour:
      return text(index, "%H:%M on %-d %B") + year;
    case Step::kDay:
      return text(index, "%-d %B") + year;
    case Step::kWeek:
      break;
  }
  return text(index, "week %-V (from %-d %B") + year + ")";
}

}  // namespace mpm::history
