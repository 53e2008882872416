#include "tests/calibrate/readings.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "config/load_unit.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/derived_settings.hpp"
#include "sim/loop/closed_loop.hpp"

namespace mpm::calibrate {
namespace {

const std::string kConfig = std::string(MPM_SOURCE_DIR) + "/config/";

template <typename Result>
void check(const Result& result, const std::string& file) {
  for (const config::Finding& finding : result.findings)
    if (finding.severity == config::Severity::kError)
      throw std::runtime_error(file + ": " + config::format(finding));
}

sim::LoopSetup loop_setup(const std::string& plant, const std::string& scenario) {
  const std::string file = kConfig + "plants/" + plant + ".yaml";
  config::LoadResult unit = config::load_unit(file);
  check(unit, file);
  sim::LoopSetup setup;
  setup.unit = std::move(unit.config);
  setup.controller_model = setup.unit.model;
  const config::ScenarioResult loaded = config::load_scenario(
      config::find_scenario(scenario, file), setup.unit, 1e6 * setup.unit.sample_time_s);
  check(loaded, scenario);
  setup.scenario = loaded.scenario;
  return setup;
}

/// A detector that sees what the monitor's would, with all rows counting alike.
MismatchDetector detector_of(const config::UnitConfig& unit) {
  const LinearModel model(unit.model);
  const DerivedSettings derived = derive_settings(unit.model, model, unit.monitor, unit.alarms);
  const SignalCounts counts = unit.counts();
  return {{counts.inputs(),
           counts.cv,
           derived.fir_lags,
           derived.residual_order,
           derived.tail_poles,
           {},
           0,
           derived.residual_poles},
          {MemoryLength{}},
          derived.remembered,
          derived.evaluation_stride,
          model,
          derived.materiality};
}

void read(int rows_per_column, MismatchDetector& detector, Run& run) {
  const RegressionShape& shape = detector.shape();
  for (int j = 0; j < shape.cvs; ++j) {
    detector.evaluate(j);
    const EstimateNoise noise = estimate_noise(detector.memory(j));
    const double per_freedom = shape.columns() / noise.freedom;
    for (int i = 0; i < shape.inputs; ++i) {
      const ChannelEvidence& evidence = detector.evidence(j, i);
      if (evidence.numerator_freedom == 0.0) continue;
      run.readings.push_back(
          {.rows_per_column = rows_per_column,
           .directed = evidence.directed_statistic * directed_inflation(per_freedom),
           .directed_freedom = evidence.directed_freedom,
           .block = evidence.block_statistic * block_inflation(per_freedom),
           .block_freedom = shape.block(),
           .columns_per_freedom = per_freedom,
           .freedom = noise.freedom});
    }
  }
}

Run read_loop(const std::string& plant, sim::LoopSetup setup, std::uint64_t seed) {
  setup.seed = seed;
  Run run{plant, {}, {}};
  const SignalCounts counts = setup.unit.counts();
  MismatchDetector detector = detector_of(setup.unit);
  const int columns = detector.shape().columns();
  sim::ClosedLoop loop(setup);
  Eigen::VectorXd inputs(counts.inputs());
  Eigen::VectorXd residuals(counts.cv);
  int rows = 0;
  for (const int rows_per_column : kRowsPerColumn) {
    while (rows < rows_per_column * columns) {
      const Frame& frame = loop.step();
      if (!loop.finite()) throw std::runtime_error(plant + ": the loop diverges");
      inputs << frame[SignalKind::kMv].values, frame[SignalKind::kDv].values;
      residuals = frame[SignalKind::kCv].values - frame[SignalKind::kPrediction].values;
      detector.update(inputs, residuals);
      rows += detector.took_row(0) ? 1 : 0;
    }
    read(rows_per_column, detector, run);
  }
  for (int j = 0; j < counts.cv; ++j)
    run.clipped_shares.push_back(detector.regression(j).noise().clipped_share());
  return run;
}

}  // namespace

std::vector<Run> read_loops(const Loops& loops) {
  std::vector<sim::LoopSetup> setups;
  for (const std::string& plant : loops.plants) setups.push_back(loop_setup(plant, loops.scenario));
  const auto seeds = static_cast<std::size_t>(loops.seeds);
  std::vector<Run> runs(setups.size() * seeds);
  std::atomic<std::size_t> next{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t k = next++; k < runs.size(); k = next++) {
      try {
        runs[k] =
            read_loop(loops.plants[k / seeds], setups[k / seeds], loops.first_seed + k % seeds);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        failure = std::current_exception();
        next = runs.size();
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int t = 0; t < std::max(loops.threads, 1); ++t) workers.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  return runs;
}

}  // namespace mpm::calibrate
