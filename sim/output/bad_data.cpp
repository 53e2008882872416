#include "sim/output/bad_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace mpm::sim {
namespace {

using config::BadDataKind;
using Eigen::Index;

constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr std::int64_t kTrialSamples = 3000;

std::uint64_t stream_index(BadDataKind kind, std::size_t entry_of_kind, std::size_t signal) {
  return (static_cast<std::uint64_t>(kind) << 48U) + (entry_of_kind << 32U) + signal;
}

bool spoils_rows(BadDataKind kind) {
  return kind == BadDataKind::kGaps || kind == BadDataKind::kTimeJitter ||
         kind == BadDataKind::kClockSteps;
}

/// Place in the order in which kinds are applied.
int rank(BadDataKind kind) {
  constexpr BadDataKind kOrder[] = {BadDataKind::kClipping,   BadDataKind::kSpikes,
                                    BadDataKind::kFrozen,     BadDataKind::kUncertain,
                                    BadDataKind::kMissing,    BadDataKind::kGaps,
                                    BadDataKind::kClockSteps, BadDataKind::kTimeJitter};
  return static_cast<int>(std::find(std::begin(kOrder), std::end(kOrder), kind) -
                          std::begin(kOrder));
}

std::pair<SignalKind, int> find_signal(const std::string& tag, const config::UnitConfig& unit) {
  for (std::size_t i = 0; i < unit.mv.size(); ++i)
    if (unit.mv[i].tag == tag) return {SignalKind::kMv, static_cast<int>(i)};
  for (std::size_t i = 0; i < unit.dv.size(); ++i)
    if (unit.dv[i].tag == tag) return {SignalKind::kDv, static_cast<int>(i)};
  for (std::size_t i = 0; i < unit.cv.size(); ++i) {
    if (unit.cv[i].tag == tag) return {SignalKind::kCv, static_cast<int>(i)};
    if (unit.cv[i].prediction == tag) return {SignalKind::kPrediction, static_cast<int>(i)};
    if (unit.cv[i].setpoint == tag) return {SignalKind::kSetpoint, static_cast<int>(i)};
  }
  throw std::invalid_argument("bad_data: no signal '" + tag + "' in this unit");
}

/// The range that a share of the values lies beyond, half of it on each side.
std::pair<double, double> central_range(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(std::llround(part * last))];
  };
  return {at(share / 2.0), at(1.0 - share / 2.0)};
}

}  // namespace

bool BadDataFilter::Occasions::next() {
  if (run_ <= 0.0) return stream_.uniform() < share_;
  if (share_ <= 0.0) return false;
  const double cycle = run_ / share_;
  if (sample_ >= cycle_end_) {
    run_start_ = cycle_end_ + stream_.uniform() * (cycle - run_);
    cycle_end_ += cycle;
  }
  const bool bad = sample_ >= run_start_ && sample_ < run_start_ + run_;
  sample_ += 1.0;
  return bad;
}

BadDataFilter::BadDataFilter(const LoopSetup& setup)
    : sample_time_s_(setup.unit.sample_time_s), reported_(setup.unit.counts()) {
  for (const config::BadData& bad : setup.scenario.bad_data) add_entry(setup, bad);
  find_ranges(setup);
  for (std::size_t i = 0; i < entries_.size(); ++i) order_.push_back(i);
  std::stable_sort(order_.begin(), order_.end(), [this](std::size_t left, std::size_t right) {
    return rank(entries_[left].kind) < rank(entries_[right].kind);
  });
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (const Target& target : entries_[i].targets) {
      details_[i].low.push_back(target.low);
      details_[i].high.push_back(target.high);
    }
}

void BadDataFilter::add_entry(const LoopSetup& setup, const config::BadData& bad) {
  const auto use = static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(),
                    [&](const Entry& other) { return other.kind == bad.kind; }));
  const auto stream = [&](std::size_t signal) {
    return RandomStream(setup.seed, StreamPurpose::kBadData, stream_index(bad.kind, use, signal));
  };
  Entry entry{bad.kind, {bad.from_s, bad.until_s, sample_time_s_}, bad.share, {}, {}, {}};
  Details details;
  for (std::size_t i = 0; i < bad.tags.size(); ++i) {
    const auto [kind, index] = find_signal(bad.tags[i], setup.unit);
    const std::size_t signal =
        (static_cast<std::size_t>(kind) << 16U) + static_cast<std::size_t>(index);
    entry.targets.push_back({{kind, index},
                             Occasions(bad.share, bad.run_samples, stream(signal)),
                             bad.low.value_or(-kNoBound),
                             bad.high.value_or(kNoBound),
                             i < bad.sizes.size() ? bad.sizes[i] : 0.0});
  }
  if (spoils_rows(bad.kind)) entry.row.emplace_back(bad.share, bad.run_samples, stream(0));
  if (!bad.steps_s.empty()) {
    if (!setup.samples)
      throw std::invalid_argument("clock_steps: the length of the run is not given (--samples)");
    const std::int64_t first = entry.range.first;
    const std::int64_t end = std::min(entry.range.end, *setup.samples);
    for (const double size_s : bad.steps_s) {
      const auto span = static_cast<std::uint64_t>(std::max<std::int64_t>(1, end - first));
      entry.steps.push_back(
          {first + static_cast<std::int64_t>(entry.row.front().stream().below(span)), size_s});
    }
    std::sort(entry.steps.begin(), entry.steps.end(),
              [](const ClockStep& left, const ClockStep& right) {
                return left.interval < right.interval;
              });
    for (std::size_t i = 0; i < entry.steps.size(); ++i) {
      entry.steps[i].size_s = bad.steps_s[i];
      details.step_times_s.push_back(static_cast<double>(entry.steps[i].interval) * sample_time_s_);
    }
  }
  entries_.push_back(std::move(entry));
  counts_.emplace_back();
  details_.push_back(std::move(details));
}

void BadDataFilter::find_ranges(const LoopSetup& setup) {
  std::vector<std::vector<double>> values;
  std::vector<Target*> targets;
  std::vector<double> shares;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const config::BadData& bad = setup.scenario.bad_data[i];
    if (bad.kind != BadDataKind::kClipping || bad.low || bad.high) continue;
    for (Target& target : entries_[i].targets) {
      targets.push_back(&target);
      shares.push_back(bad.share);
    }
  }
  if (targets.empty()) return;
  values.resize(targets.size());
  ClosedLoop loop(setup);
  const std::int64_t samples = std::max<std::int64_t>(1, setup.samples.value_or(kTrialSamples));
  for (std::int64_t k = 0; k < samples; ++k) {
    const Frame& frame = loop.step();
    if (!loop.finite()) return;  // the run itself will tell
    for (std::size_t i = 0; i < targets.size(); ++i)
      values[i].push_back(frame[targets[i]->signal.kind].values(targets[i]->signal.index));
  }
  for (std::size_t i = 0; i < targets.size(); ++i)
    std::tie(targets[i]->low, targets[i]->high) = central_range(std::move(values[i]), shares[i]);
}

const Frame* BadDataFilter::apply(const Frame& frame) {
  reported_ = frame;
  time_error_s_ = 0.0;
  bool present = true;
  for (const std::size_t i : order_) {
    Entry& entry = entries_[i];
    const bool active = entry.range.contains(frame.interval);
    if (spoils_rows(entry.kind)) {
      present = spoil_row(entry, active, counts_[i]) && present;
    } else {
      spoil_values(entry, active, counts_[i]);
    }
  }
  time_error_s_ = std::round((time_error_s_ + clock_s_) * 1e6) * 1e-6;
  reported_.source_time_ns += std::llround(time_error_s_ * 1e9);
  return present ? &reported_ : nullptr;
}

void BadDataFilter::spoil_values(Entry& entry, bool active, BadDataCount& count) {
  for (Target& target : entry.targets) {
    SignalBlock& block = reported_[target.signal.kind];
    if (active) {
      ++count.possible;
      if (spoil(entry.kind, target, block)) ++count.samples;
    }
    target.last = block.values(target.signal.index);
    target.has_last = true;
  }
}

bool BadDataFilter::spoil(BadDataKind kind, Target& target, SignalBlock& block) {
  double& value = block.values(target.signal.index);
  Quality& quality = block.quality[static_cast<std::size_t>(target.signal.index)];
  if (kind == BadDataKind::kClipping) {
    const double inside = std::clamp(value, target.low, target.high);
    return std::exchange(value, inside) != inside;
  }
  if (!target.occasions.next()) return false;
  switch (kind) {
    case BadDataKind::kMissing:
      value = std::numeric_limits<double>::quiet_NaN();
      quality = Quality::kBad;
      return true;
    case BadDataKind::kUncertain:
      quality = std::max(quality, Quality::kUncertain);
      return true;
    case BadDataKind::kFrozen:
      if (target.has_last) value = target.last;
      return target.has_last;
    case BadDataKind::kSpikes:
      value += target.occasions.stream().uniform() < 0.5 ? -target.size : target.size;
      return true;
    default:
      return false;
  }
}

bool BadDataFilter::spoil_row(Entry& entry, bool active, BadDataCount& count) {
  for (const ClockStep& step : entry.steps) {
    if (step.interval != reported_.interval) continue;
    clock_s_ += step.size_s;
    ++count.samples;
  }
  if (!active) return true;
  ++count.possible;
  if (entry.kind == BadDataKind::kTimeJitter && entry.share > 0.0) {
    const double part = 2.0 * entry.row.front().stream().uniform() - 1.0;
    time_error_s_ += part * entry.share * sample_time_s_;
    ++count.samples;
  }
  if (entry.kind != BadDataKind::kGaps || !entry.row.front().next()) return true;
  ++count.samples;
  return false;
}

std::vector<std::string> uncertain_tags(const config::ScenarioConfig& scenario) {
  std::vector<std::string> tags;
  for (const config::BadData& bad : scenario.bad_data)
    if (bad.kind == BadDataKind::kUncertain)
      tags.insert(tags.end(), bad.tags.begin(), bad.tags.end());
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

}  // namespace mpm::sim
