#include "tests/study/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "config/load_unit.hpp"
#include "core/monitor/monitor.hpp"
#include "sim/scenario/prepare.hpp"
#include "sim/scenario/random_change.hpp"
#include "sim/scenario/stability.hpp"

namespace mpm::study {
namespace {

constexpr double kSame = 1e-9;

std::string first_error(const std::vector<config::Finding>& findings) {
  for (const config::Finding& finding : findings)
    if (finding.severity == config::Severity::kError) return config::format(finding);
  return "";
}

Truth truth_of(const std::vector<sim::ChannelChange>& changes, int cv, int input, double time_s,
               double material, bool before) {
  double gain = 1.0;
  double time_constant = 1.0;
  double dead_time_s = 0.0;
  for (const sim::ChannelChange& change : changes) {
    if (change.cv != cv || change.input != input || change.from_s > time_s + kSame ||
        change.until_s <= time_s + kSame)
      continue;
    gain *= change.gain_ratio;
    time_constant *= change.time_constant_ratio;
    dead_time_s += change.dead_time_error_s;
  }
  const bool gain_only = std::abs(time_constant - 1.0) < kSame && std::abs(dead_time_s) < kSame;
  if (gain_only && std::abs(gain - 1.0) < kSame) return before ? Truth::kReturned : Truth::kHealthy;
  return gain_only && std::abs(gain - 1.0) < material - kSame ? Truth::kSmall : Truth::kWrong;
}

std::vector<Timeline> timelines(const sim::LoopSetup& setup, double material) {
  std::vector<double> times = {0.0};
  for (const sim::ChannelChange& change : setup.changes) {
    times.push_back(change.from_s);
    if (std::isfinite(change.until_s)) times.push_back(change.until_s);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<Timeline> result;
  for (int input = 0; input < setup.unit.model.input_count; ++input) {
    for (int cv = 0; cv < setup.unit.model.cv_count; ++cv) {
      Timeline line;
      bool changed = false;
      for (const double time_s : times) {
        const Truth truth = truth_of(setup.changes, cv, input, time_s, material, changed);
        changed = changed || truth != Truth::kHealthy;
        line.add(static_cast<std::int64_t>(std::ceil(time_s / setup.unit.sample_time_s - kSame)),
                 truth);
      }
      result.push_back(line);
    }
  }
  return result;
}

std::vector<ChannelReading> read(const Monitor& monitor, const SignalCounts& counts,
                                 const std::vector<Timeline>& truth, std::int64_t sample) {
  std::vector<ChannelReading> readings;
  for (int input = 0; input < counts.inputs(); ++input) {
    for (int cv = 0; cv < counts.cv; ++cv) {
      const ChannelStatus& status = monitor.channel(cv, input);
      readings.push_back({truth[readings.size()].at(sample), status.verdict, status.reason,
                          status.p_value, status.statistic,
                          monitor.alarm(cv, input) == AlarmState::kActive});
    }
  }
  return readings;
}

void count_tail(const Monitor& monitor, const SignalCounts& counts, std::int64_t sample,
                RunRecord& record) {
  std::size_t bin = 0;
  while (bin + 1 < kTailBins.size() && kTailBins[bin + 1] <= sample) ++bin;
  TailBin& tail = record.tail[bin];
  std::size_t channel = 0;
  for (int input = 0; input < counts.inputs(); ++input) {
    for (int cv = 0; cv < counts.cv; ++cv, ++channel) {
      const ChannelStatus& status = monitor.channel(cv, input);
      if (record.truth[channel].at(sample) != Truth::kHealthy ||
          status.reason == Reason::kWarmingUp || status.reason == Reason::kBadData ||
          status.reason == Reason::kIsolating)
        continue;
      ++tail.evaluations;
      for (std::size_t level = 0; level < kTailLevels.size(); ++level)
        tail.below[level] += status.p_value < kTailLevels[level] ? 1 : 0;
      tail.mismatches += status.verdict == Verdict::kMismatch ? 1 : 0;
    }
  }
}

void keep_alarms(const Monitor& monitor, int cvs, std::int64_t sample, RunRecord& record) {
  for (const AlarmTransition& transition : monitor.transitions()) {
    const int channel = transition.input * cvs + transition.cv;
    record.alarms.push_back({sample, channel, transition.to,
                             record.truth[static_cast<std::size_t>(channel)].at(sample)});
  }
}

}  // namespace

Truth Timeline::at(std::int64_t sample) const {
  Truth truth = Truth::kHealthy;
  for (const Part& part : parts_)
    if (part.from <= sample) truth = part.truth;
  return truth;
}

std::optional<std::int64_t> Timeline::first(Truth truth) const {
  for (const Part& part : parts_)
    if (part.truth == truth) return part.from;
  return std::nullopt;
}

std::optional<Prepared> prepare(const Experiment& experiment, std::string& why_not) {
  const std::string unit_file =
      std::string(MPM_SOURCE_DIR) + "/config/plants/" + experiment.unit + ".yaml";
  config::LoadResult loaded = config::load_unit(unit_file);
  if (!loaded.ok()) {
    why_not = first_error(loaded.findings);
    return std::nullopt;
  }
  Prepared prepared{experiment, {}};
  sim::LoopSetup& setup = prepared.setup;
  setup.unit = std::move(loaded.config);
  setup.controller_model = setup.unit.model;
  setup.seed = experiment.seeds.first;
  try {
    if (experiment.scenario != "none") {
      config::ScenarioResult scenario =
          config::load_scenario(config::find_scenario(experiment.scenario, unit_file), setup.unit,
                                experiment.samples * setup.unit.sample_time_s);
      if (!scenario.ok()) {
        why_not = first_error(scenario.findings);
        return std::nullopt;
      }
      setup.scenario = std::move(scenario.scenario);
    }
    if (experiment.settings != nullptr) experiment.settings(setup.unit.monitor);
    if (experiment.changes.empty()) return prepared;
    sim::LoopSetup trial = setup;
    sim::hide_changes(trial);
    trial.changes.insert(trial.changes.end(), experiment.changes.begin(), experiment.changes.end());
    const std::optional<std::string> reason = sim::why_not_stabilisable(
        trial.controller_model, sim::plant_stages(trial.unit.model, trial.changes),
        static_cast<int>(trial.unit.mv.size()), trial.unit.simulation.cv_weights);
    if (reason) why_not = *reason;
    for (sim::ChannelChange& change : trial.changes) change.from_s = 0.0;
    if (!reason && !sim::settles(trial)) why_not = "the loop does not settle with these changes";
  } catch (const std::exception& error) {
    why_not = error.what();
  }
  if (!why_not.empty()) return std::nullopt;
  return prepared;
}

RunRecord run_one(const Prepared& prepared, std::uint64_t seed,
                  std::atomic<std::int64_t>& progress) {
  const Experiment& experiment = prepared.experiment;
  sim::LoopSetup setup = prepared.setup;
  setup.seed = seed;
  sim::hide_changes(setup);
  setup.changes.insert(setup.changes.end(), experiment.changes.begin(), experiment.changes.end());

  const SignalCounts counts = setup.unit.counts();
  std::vector<bool> has_prediction;
  for (const config::CvSignal& cv : setup.unit.cv) has_prediction.push_back(!cv.prediction.empty());
  sim::ClosedLoop loop(setup);
  Monitor monitor(setup.unit.model, counts, has_prediction, setup.unit.monitor, setup.unit.alarms);

  RunRecord record;
  record.truth = timelines(setup, experiment.material);
  std::vector<int> stops = experiment.also_at;
  stops.push_back(experiment.samples);
  constexpr int kProgressStep = 500;
  for (int k = 0; k < experiment.samples; ++k) {
    const Frame& frame = loop.step();
    if (!loop.finite()) {
      record.diverged = true;
      progress += experiment.samples - k / kProgressStep * kProgressStep;
      return record;
    }
    monitor.push(frame);
    ++record.samples;
    keep_alarms(monitor, counts.cv, k, record);
    if (record.samples % kStride == 0) count_tail(monitor, counts, k, record);
    if (record.readings.size() < stops.size() && record.samples == stops[record.readings.size()])
      record.readings.push_back(read(monitor, counts, record.truth, k));
    if (record.samples % kProgressStep == 0) progress += kProgressStep;
  }
  progress += experiment.samples % kProgressStep;
  return record;
}

}  // namespace mpm::study
