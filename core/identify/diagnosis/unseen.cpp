#include "core/identify/diagnosis/unseen.hpp"

#include <algorithm>
#include <limits>

#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/horizons.hpp"
#include "core/identify/fit/row_weights.hpp"
#include "core/identify/fit/whitening.hpp"

namespace mpm {

using Eigen::Index;

namespace {

double slowest_samples(const ModelSpec& model) {
  double slowest = 1.0;
  for (const ChannelSpec& channel : model.channels)
    slowest = std::max(slowest, slowest_time_constant_s(channel, model.sample_time_s));
  return slowest / model.sample_time_s;
}

}  // namespace

Unseen::Unseen(const Recording& recording, Index rows, const ModelSpec& model, std::uint64_t seed)
    : simulator_(recording),
      rows_(rows),
      block_(static_cast<Index>(kBlockTimeConstants * slowest_samples(model)) + kBlockRows),
      horizons_(horizons_of(model, rows / kHorizonsInRows)),
      seed_(seed) {}

Eigen::VectorXd Unseen::measured(int cv) const {
  return simulator_.recording().cvs.col(cv).tail(rows_);
}

Eigen::VectorXd Unseen::simulated(const ModelSpec& model, int cv) {
  return free_run(simulator_, model, cv).tail(rows_);
}

Eigen::VectorXd Unseen::residual_throughout(const ModelSpec& model, int cv) {
  return simulator_.recording().cvs.col(cv) - free_run(simulator_, model, cv);
}

Eigen::VectorXd Unseen::prediction_errors(const Eigen::Ref<const Eigen::VectorXd>& residual,
                                          Index horizon) const {
  Eigen::VectorXd errors = squared_prediction_errors(residual, horizon);
  const Recording& recording = simulator_.recording();
  for (const Border& border : recording.borders) {
    const Index row = border.row - (recording.samples() - rows_);
    const Index first = std::max<Index>(0, row - horizon), last = std::min(row, errors.size());
    if (first < last)
      errors.segment(first, last - first).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return errors;
}

Eigen::VectorXd Unseen::innovations(const Eigen::Ref<const Eigen::VectorXd>& residual) const {
  const Recording& recording = simulator_.recording();
  const Eigen::VectorXd known = residual.array().isFinite().cast<double>();
  const Eigen::VectorXd weights = rows_with_past(known, runs_of(recording), kMostOrder);
  Eigen::VectorXd centred = residual.array().isFinite().select(residual, 0.0);
  centred.array() -= known.array() * centred.sum() / std::max(1.0, known.sum());
  Whitening noise = fit_whitening(centred, weights, {.order = kMostOrder, .bound = 0.0});
  noise.borders = recording.borders;
  const Eigen::VectorXd errors = noise.apply(centred).cwiseAbs2();
  return (weights.array() > 0.0)
      .select(errors, std::numeric_limits<double>::quiet_NaN())
      .tail(rows_);
}

Eigen::MatrixXd Unseen::free_runs(const ModelSpec& model) {
  return mpm::free_runs(simulator_, model);
}

}  // namespace mpm
