#include "tests/study/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <stdexcept>

namespace mpm::study {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFamilyRate = 0.01;

std::string level_text(double level) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", level);
  return text;
}

std::string verdict_text(const ChannelReading& reading) {
  return std::string(reading.verdict == Verdict::kUndetermined ? to_string(reading.reason)
                                                               : to_string(reading.verdict));
}

/// A p-value that is of now.
bool has_p_value(const ChannelReading& reading) {
  return reading.reason != Reason::kWarmingUp && reading.reason != Reason::kBadData &&
         reading.reason != Reason::kIsolating;
}

using RunCount = std::function<Count(const RunRecord&)>;

class Builder {
 public:
  explicit Builder(Summary& summary, const std::vector<const RunRecord*>& runs)
      : summary_(summary), runs_(runs) {}

  void add(const std::string& name, int at, const RunCount& count,
           Within within = Within::kIndependent) {
    std::vector<Count> counts;
    for (const RunRecord* run : runs_) counts.push_back(count(*run));
    const Share share = share_of(counts, within);
    if (share.total > 0) summary_.metrics.push_back({name, at, share});
  }

 private:
  Summary& summary_;
  const std::vector<const RunRecord*>& runs_;
};

using Readings = std::vector<ChannelReading>;

Count count_if(const Readings& readings, Truth truth,
               const std::function<bool(const ChannelReading&)>& hit) {
  Count count;
  for (const ChannelReading& reading : readings) {
    if (reading.truth != truth) continue;
    ++count.total;
    count.hits += hit(reading) ? 1 : 0;
  }
  return count;
}

/// One trial per run that has such channels: whether any of them hits.
Count any(const Count& channels) { return {channels.hits > 0 ? 1 : 0, channels.total > 0 ? 1 : 0}; }

bool smaller(const ChannelReading& left, const ChannelReading& right) {
  if (left.p_value != right.p_value) return left.p_value < right.p_value;
  return left.statistic > right.statistic;
}

/// Whether every wrong channel says more than every one that is not.
Count ranked(const Readings& readings) {
  Count count;
  bool on_top = true;
  bool compared = false;
  for (const ChannelReading& wrong : readings) {
    if (wrong.truth != Truth::kWrong) continue;
    for (const ChannelReading& other : readings) {
      if (other.truth == Truth::kWrong) continue;
      compared = true;
      on_top = on_top && smaller(wrong, other);
    }
  }
  count.total = compared ? 1 : 0;
  count.hits = compared && on_top ? 1 : 0;
  return count;
}

void add_readings(Builder& builder, std::size_t which, int at) {
  const auto readings = [which](const RunRecord& run) -> const Readings& {
    return run.readings[which];
  };
  for (const double level : {0.05, 0.01, 0.001, 0.0001})
    builder.add("healthy_p_" + level_text(level), at, [=](const RunRecord& run) {
      return count_if(readings(run), Truth::kHealthy, [=](const ChannelReading& reading) {
        return has_p_value(reading) && reading.p_value < level;
      });
    });
  for (const Truth truth : {Truth::kHealthy, Truth::kWrong})
    for (const char* verdict :
         {"match", "mismatch", "warming_up", "not_excited", "collinear", "bad_data"})
      builder.add((truth == Truth::kHealthy ? "healthy_" : "wrong_") + std::string(verdict), at,
                  [=](const RunRecord& run) {
                    return count_if(readings(run), truth, [=](const ChannelReading& reading) {
                      return verdict_text(reading) == verdict;
                    });
                  });
  builder.add("small_mismatch", at, [=](const RunRecord& run) {
    return count_if(readings(run), Truth::kSmall, [](const ChannelReading& reading) {
      return reading.verdict == Verdict::kMismatch;
    });
  });
  builder.add("family_p", at, [=](const RunRecord& run) {
    const double level = kFamilyRate / static_cast<double>(readings(run).size());
    return any(count_if(readings(run), Truth::kHealthy,
                        [=](const ChannelReading& reading) { return reading.p_value < level; }));
  });
  builder.add("false_mismatch_runs", at, [=](const RunRecord& run) {
    return any(count_if(readings(run), Truth::kHealthy, [](const ChannelReading& reading) {
      return reading.verdict == Verdict::kMismatch;
    }));
  });
  builder.add("ranked", at, [=](const RunRecord& run) { return ranked(readings(run)); });
}

void add_tail(Builder& builder) {
  builder.add(
      "tail_mismatch", 0,
      [](const RunRecord& run) {
        Count count;
        for (const TailBin& bin : run.tail) {
          count.hits += bin.mismatches;
          count.total += bin.evaluations;
        }
        return count;
      },
      Within::kOneTrial);
  for (std::size_t level = 0; level < kTailLevels.size(); ++level) {
    const std::string name = "tail_" + level_text(kTailLevels[level]);
    builder.add(
        name, 0,
        [=](const RunRecord& run) {
          Count count;
          for (const TailBin& bin : run.tail) {
            count.hits += bin.below[level];
            count.total += bin.evaluations;
          }
          return count;
        },
        Within::kOneTrial);
    for (std::size_t bin = 0; bin < kTailBins.size(); ++bin)
      builder.add(
          name + "_from_" + std::to_string(kTailBins[bin]), 0,
          [=](const RunRecord& run) {
            return Count{run.tail[bin].below[level], run.tail[bin].evaluations};
          },
          Within::kOneTrial);
  }
}

/// Sample from which on the first channel is wrong.
std::optional<std::int64_t> onset(const RunRecord& run) {
  std::optional<std::int64_t> first;
  for (const Timeline& line : run.truth) {
    const std::optional<std::int64_t> begin = line.first(Truth::kWrong);
    if (begin && (!first || *begin < *first)) first = begin;
  }
  return first;
}

bool raised_right(const AlarmChange& change) {
  return change.to == AlarmState::kActive && change.truth == Truth::kWrong;
}
bool raised_false(const AlarmChange& change) {
  return change.to == AlarmState::kActive && change.truth == Truth::kHealthy;
}

void add_alarms(Builder& builder) {
  builder.add("alarmed", 0, [](const RunRecord& run) {
    if (!onset(run)) return Count{};
    return Count{std::any_of(run.alarms.begin(), run.alarms.end(), raised_right) ? 1 : 0, 1};
  });
  builder.add("alarmed_channels", 0, [](const RunRecord& run) {
    Count count;
    for (std::size_t c = 0; c < run.truth.size(); ++c) {
      if (!run.truth[c].first(Truth::kWrong)) continue;
      ++count.total;
      count.hits +=
          std::any_of(run.alarms.begin(), run.alarms.end(),
                      [c](const AlarmChange& change) {
                        return change.channel == static_cast<int>(c) && raised_right(change);
                      })
              ? 1
              : 0;
    }
    return count;
  });
  builder.add("first_alarm_right", 0, [](const RunRecord& run) {
    const auto first =
        std::find_if(run.alarms.begin(), run.alarms.end(),
                     [](const AlarmChange& change) { return change.to == AlarmState::kActive; });
    if (!onset(run) || first == run.alarms.end()) return Count{};
    return Count{raised_right(*first) ? 1 : 0, 1};
  });
  builder.add("false_alarm_runs", 0, [](const RunRecord& run) {
    return Count{std::any_of(run.alarms.begin(), run.alarms.end(), raised_false) ? 1 : 0, 1};
  });
  builder.add("alarms_right", 0, [](const RunRecord& run) {
    const auto right = std::count_if(run.alarms.begin(), run.alarms.end(), raised_right);
    return Count{right, right + std::count_if(run.alarms.begin(), run.alarms.end(), raised_false)};
  });
  builder.add("healthy_in_alarm", 0, [](const RunRecord& run) {
    return count_if(run.readings.back(), Truth::kHealthy,
                    [](const ChannelReading& reading) { return reading.in_alarm; });
  });
}

bool is_in_alarm_at(const RunRecord& run, int channel, std::int64_t sample) {
  bool active = false;
  for (const AlarmChange& change : run.alarms)
    if (change.channel == channel && change.sample <= sample)
      active = change.to == AlarmState::kActive;
  return active;
}

bool raised_after(const RunRecord& run, int channel, std::int64_t sample) {
  return std::any_of(run.alarms.begin(), run.alarms.end(), [=](const AlarmChange& change) {
    return change.channel == channel && change.sample > sample && change.to == AlarmState::kActive;
  });
}

void add_return(Builder& builder) {
  builder.add("cleared_after_return", 0, [](const RunRecord& run) {
    Count count;
    for (std::size_t c = 0; c < run.truth.size(); ++c) {
      const std::optional<std::int64_t> back = run.truth[c].first(Truth::kReturned);
      const auto channel = static_cast<int>(c);
      if (!back || (!is_in_alarm_at(run, channel, *back) && !raised_after(run, channel, *back)))
        continue;
      ++count.total;
      count.hits += run.readings.back()[c].in_alarm ? 0 : 1;
    }
    return count;
  });
}

Quartiles quartiles(const std::vector<double>& values) {
  return {static_cast<std::int64_t>(values.size()), quantile(values, 0.25), quantile(values, 0.5),
          quantile(values, 0.75)};
}

Quartiles alarm_delays(const std::vector<const RunRecord*>& runs) {
  std::vector<double> delays;
  for (const RunRecord* run : runs) {
    const std::optional<std::int64_t> begin = onset(*run);
    if (!begin) continue;
    const auto first = std::find_if(run->alarms.begin(), run->alarms.end(), raised_right);
    delays.push_back(first == run->alarms.end() ? kInfinity
                                                : static_cast<double>(first->sample - *begin));
  }
  return quartiles(delays);
}

Quartiles clear_delays(const std::vector<const RunRecord*>& runs) {
  std::vector<double> delays;
  for (const RunRecord* run : runs) {
    for (std::size_t c = 0; c < run->truth.size(); ++c) {
      const std::optional<std::int64_t> back = run->truth[c].first(Truth::kReturned);
      const auto channel = static_cast<int>(c);
      if (!back || !is_in_alarm_at(*run, channel, *back)) continue;
      const auto cleared =
          std::find_if(run->alarms.begin(), run->alarms.end(), [&](const AlarmChange& change) {
            return change.channel == channel && change.sample > *back &&
                   change.to == AlarmState::kCleared;
          });
      delays.push_back(cleared == run->alarms.end() ? kInfinity
                                                    : static_cast<double>(cleared->sample - *back));
    }
  }
  return quartiles(delays);
}

}  // namespace

const std::vector<std::string>& verdict_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"match", "mismatch"};
    for (const Reason reason :
         {Reason::kWarmingUp, Reason::kNotExcited, Reason::kCollinear, Reason::kBadData,
          Reason::kControllerOff, Reason::kConstrained, Reason::kIsolating})
      all.emplace_back(to_string(reason));
    return all;
  }();
  return names;
}

const Share* Summary::find(const std::string& name, int at) const {
  for (const Metric& metric : metrics)
    if (metric.name == name && metric.at == at) return &metric.share;
  return nullptr;
}

Summary summarise(const Experiment& experiment, const std::vector<RunRecord>& runs) {
  Summary summary;
  summary.experiment = experiment;
  summary.runs = static_cast<std::int64_t>(runs.size());
  std::vector<const RunRecord*> complete;
  for (const RunRecord& run : runs) {
    if (run.diverged) {
      ++summary.diverged;
      continue;
    }
    complete.push_back(&run);
    summary.channels = static_cast<int>(run.truth.size());
    summary.samples += run.samples;
    for (const AlarmChange& change : run.alarms) {
      summary.right_alarms += raised_right(change) ? 1 : 0;
      summary.false_alarms += raised_false(change) ? 1 : 0;
      summary.alarms_after_return +=
          change.to == AlarmState::kActive && change.truth == Truth::kReturned ? 1 : 0;
    }
  }
  summary.false_alarms_interval = poisson(summary.false_alarms);
  if (complete.empty()) return summary;
  Builder builder(summary, complete);
  for (std::size_t i = 0; i < experiment.also_at.size(); ++i)
    add_readings(builder, i, experiment.also_at[i]);
  add_readings(builder, experiment.also_at.size(), experiment.samples);
  add_tail(builder);
  add_alarms(builder);
  add_return(builder);
  summary.alarm_delay = alarm_delays(complete);
  summary.clear_delay = clear_delays(complete);
  return summary;
}

std::vector<Finding> check_bounds(const Summary& summary) {
  std::vector<Finding> findings;
  if (summary.diverged > 0)
    findings.push_back({std::to_string(summary.diverged) + " runs diverged", false});
  for (const Bound& bound : summary.experiment.bounds) {
    const Share* share = summary.find(bound.metric, bound.at);
    if (share == nullptr) {
      findings.push_back({bound.metric + ": nothing to measure it on", false});
      continue;
    }
    // As many trials as are worth that of independent ones.
    const std::int64_t total = std::llround(share->independent_trials());
    const std::int64_t hits = std::llround(static_cast<double>(share->hits) / share->design_effect);
    const bool most = bound.side == Bound::Side::kAtMost;
    const double chance = most ? binomial_at_least(hits, total, bound.rate)
                               : binomial_at_most(hits, total, bound.rate);
    char text[200];
    std::snprintf(text, sizeof text, "%s%s: %lld of %lld (%.3g %%), at %s %.3g %%: p %.2g",
                  bound.metric.c_str(),
                  bound.at > 0 ? (" at " + std::to_string(bound.at)).c_str() : "",
                  static_cast<long long>(share->hits), static_cast<long long>(share->total),
                  100.0 * share->rate(), most ? "most" : "least", 100.0 * bound.rate, chance);
    findings.push_back({text, chance >= kBrokenBelow});
  }
  return findings;
}

}  // namespace mpm::study
