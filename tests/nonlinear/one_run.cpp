#include "tests/nonlinear/one_run.hpp"

#include "core/monitor/monitor.hpp"
#include "sim/loop/closed_loop.hpp"
#include "sim/scenario/prepare.hpp"

namespace mpm::nonlinear {

std::optional<study::Prepared> prepare_case(const Case& one, int samples, NonlinearTest test,
                                            std::string& why_not) {
  study::Experiment experiment;
  experiment.name = one.name;
  experiment.unit = one.unit;
  experiment.scenario = one.scenario;
  experiment.samples = samples;
  experiment.changes = one.changes;
  std::optional<study::Prepared> prepared = study::prepare(experiment, why_not);
  if (prepared) prepared->setup.unit.monitor.nonlinear = test;
  return prepared;
}

RunReadings run_case(const study::Prepared& prepared, std::uint64_t seed) {
  sim::LoopSetup setup = prepared.setup;
  setup.seed = seed;
  sim::hide_changes(setup);
  setup.changes.insert(setup.changes.end(), prepared.experiment.changes.begin(),
                       prepared.experiment.changes.end());
  const SignalCounts counts = setup.unit.counts();
  std::vector<bool> has_prediction;
  for (const config::CvSignal& cv : setup.unit.cv) has_prediction.push_back(!cv.prediction.empty());
  sim::ClosedLoop loop(setup);
  Monitor monitor(setup.unit.model, counts, has_prediction, setup.unit.monitor, setup.unit.alarms);
  RunReadings readings;
  for (int k = 0; k < prepared.experiment.samples; ++k) {
    const Frame& frame = loop.step();
    if (!loop.finite()) {
      readings.diverged = true;
      return readings;
    }
    monitor.push(frame);
  }
  for (int input = 0; input < counts.inputs(); ++input)
    for (int cv = 0; cv < counts.cv; ++cv)
      readings.channels.push_back({monitor.nonlinearity(cv, input),
                                   monitor.channel(cv, input).verdict,
                                   monitor.channel(cv, input).reason});
  return readings;
}

}  // namespace mpm::nonlinear
