#include "core/identify/fit/free_run.hpp"

#include "core/identify/fit/initial_state.hpp"

namespace mpm {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd free_run(Simulator& simulator, const ModelSpec& model, int cv) {
  return start_on_data(simulator.cv(model, cv), simulator.recording().cvs.col(cv),
                       decay_times(model, cv));
}

MatrixXd free_runs(Simulator& simulator, const ModelSpec& model) {
  MatrixXd result(simulator.recording().samples(), model.cv_count);
  for (int cv = 0; cv < model.cv_count; ++cv) result.col(cv) = free_run(simulator, model, cv);
  return result;
}

}  // namespace mpm
