#include "core/identify/fit/free_run.hpp"

#include "core/identify/fit/initial_state.hpp"

namespace mpm {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd free_run(Simulator& simulator, const ModelSpec& model, int cv) {
  const std::vector<double> decays = decay_times(model, cv);
  const std::vector<Run> runs = runs_of(simulator.recording());
  VectorXd result = simulator.cv(model, cv);
  for (const auto& [first, count] : runs) {
    const auto measured = simulator.recording().cvs.col(cv).segment(first, count);
    auto simulated = result.segment(first, count);
    if (runs.size() > 1) simulated.array() += mean_error(simulated, measured);
    simulated = start_on_data(simulated, measured, decays);
    if (runs.size() > 1) simulated.array() += mean_error(simulated, measured);
  }
  return result;
}

MatrixXd free_runs(Simulator& simulator, const ModelSpec& model) {
  MatrixXd result(simulator.recording().samples(), model.cv_count);
  for (int cv = 0; cv < model.cv_count; ++cv) result.col(cv) = free_run(simulator, model, cv);
  return result;
}

}  // namespace mpm
