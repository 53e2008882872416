#include "core/identify/evidence/free_run_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/plateau.hpp"
#include "core/mismatch/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

double largest(const Eigen::Ref<const Eigen::VectorXd>& values) {
  double size = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) size = std::max(size, std::abs(value));
  return size;
}

}  // namespace

MatrixXd free_run_residuals(const ModelSpec& model, const Recording& recording) {
  Simulator simulator(recording);
  MatrixXd residuals = recording.cvs - free_runs(simulator, model);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const double rounding = calibration::kRounding * largest(recording.cvs.col(cv));
    residuals.col(cv) = (residuals.col(cv).array().abs() < rounding).select(0.0, residuals.col(cv));
    if (model.output_blocks[static_cast<std::size_t>(cv)]) continue;  // it knows where it clips
    const Plateaus plateaus = find_plateaus(recording.cvs.col(cv));
    for (Index k = 0; k < recording.samples(); ++k)
      if (plateaus.hold(recording.cvs(k, cv)))
        residuals(k, cv) = std::numeric_limits<double>::quiet_NaN();
  }
  return residuals;
}

MatrixXd free_run_residuals(const std::vector<Stage>& stages, const Recording& recording) {
  MatrixXd residuals = free_run_residuals(stages.front().model, recording);
  for (std::size_t i = 1; i < stages.size(); ++i) {
    const Index rows = recording.samples() - stages[i].first;
    residuals.bottomRows(rows) = free_run_residuals(stages[i].model, recording).bottomRows(rows);
  }
  return residuals;
}

}  // namespace mpm
