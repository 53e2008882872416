#include "core/identify/evidence/free_run_residuals.hpp"

#include <limits>

#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/plateau.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

MatrixXd free_run_residuals(const ModelSpec& model, const Recording& recording) {
  Simulator simulator(recording);
  MatrixXd residuals = recording.cvs - free_runs(simulator, model);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    if (model.output_blocks[static_cast<std::size_t>(cv)]) continue;  // it knows where it clips
    const Plateaus plateaus = find_plateaus(recording.cvs.col(cv));
    for (Index k = 0; k < recording.samples(); ++k)
      if (plateaus.hold(recording.cvs(k, cv)))
        residuals(k, cv) = std::numeric_limits<double>::quiet_NaN();
  }
  return residuals;
}

}  // namespace mpm
