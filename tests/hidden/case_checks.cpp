#include "tests/hidden/case_checks.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "sim/scenario/stability.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kEigenvalueMargin = 0.2;
constexpr double kRunawayMv = 3.0, kRunawayCv = 4.0;
constexpr double kClippedLeast = 0.03, kClippedMost = 0.2;

bool goes_beyond(const MatrixXd& values, const MatrixXd& usual, const VectorXd& origin,
                 double times) {
  for (Index i = 0; i < values.cols(); ++i) {
    const double limit = times * (usual.col(i).array() - origin(i)).abs().maxCoeff();
    if (((values.col(i).array() - origin(i)).abs() > limit + 1e-12).any()) return true;
  }
  return false;
}

}  // namespace

bool is_stabilisable(const config::UnitConfig& unit, const TruePlantSpec& model,
                     const TruePlantSpec& plant) {
  const auto mvs = static_cast<Index>(unit.mv.size());
  return sim::compare_gains(steady_gain(model).leftCols(mvs), steady_gain(plant).leftCols(mvs),
                            unit.simulation.cv_weights)
      .stabilisable(kEigenvalueMargin);
}

bool runs_away(const LoopRecord& record, const LoopRecord& healthy, const TruePlantSpec& plant) {
  return !record.finite ||
         goes_beyond(record.inputs, healthy.inputs, plant.input_origin, kRunawayMv) ||
         goes_beyond(record.cvs, healthy.cvs, plant.output_origin, kRunawayCv);
}

bool clips_in_measure(const Draft& draft, const MatrixXd& cvs) {
  for (std::size_t cv = 0; cv < draft.plant.clipping.size(); ++cv) {
    const std::optional<Limited>& limits = draft.plant.clipping[cv];
    if (!limits) continue;
    const auto values = cvs.col(static_cast<Index>(cv)).head(draft.fit_samples).array();
    const auto clipped = (values <= limits->low || values >= limits->high).count();
    const double share = static_cast<double>(clipped) / draft.fit_samples;
    if (share < draft.size * kClippedLeast || share > draft.size * kClippedMost) return false;
  }
  return true;
}

MatrixXd measured_by(const TruePlantSpec& spec, const LoopRecord& record,
                     const Surroundings& around) {
  TruePlant plant(spec);
  plant.rest_at(around.aux.row(0));
  MatrixXd result(record.cvs.rows(), record.cvs.cols());
  for (Index k = 0; k < result.rows(); ++k) {
    result.row(k) = plant.measured(around.noise.row(k));
    plant.advance(record.inputs.row(k), around.aux.row(k));
  }
  return result;
}

std::vector<double> evidence_of(const Draft& draft, const std::vector<TruePlantSpec>& stages,
                                const LoopRecord& record, const Surroundings& around) {
  std::vector<double> result;
  MatrixXd before = measured_by(stages[0], record, around);
  for (std::size_t i = 1; i < stages.size(); ++i) {
    const MatrixXd after = measured_by(stages[i], record, around);
    double sum = 0.0;
    for (Index cv = 0; cv < after.cols(); ++cv)
      sum += evidence(draft.noise[static_cast<std::size_t>(cv)],
                      (after.col(cv) - before.col(cv)).head(draft.fit_samples));
    result.push_back(sum);
    before = after;
  }
  return result;
}

double weakest_part(const Draft& draft, const TruePlantSpec& healthy, const TruePlantSpec& plant,
                    const LoopRecord& record, const Surroundings& around) {
  const TrueEffect& effect = draft.truth.front();
  const CvNoise& noise = draft.noise[static_cast<std::size_t>(effect.place.cv)];
  const VectorXd whole = measured_by(plant, record, around).col(effect.place.cv);
  std::vector<VectorXd> parts;
  for (std::size_t i = 0; i < plant.channels.size(); ++i) {
    for (double TrueChannel::*number :
         {&TrueChannel::gain, &TrueChannel::time_constant, &TrueChannel::dead_time}) {
      if (plant.channels[i].*number == healthy.channels[i].*number) continue;
      TruePlantSpec without = plant;
      without.channels[i].*number = healthy.channels[i].*number;
      parts.emplace_back((whole - measured_by(without, record, around).col(effect.place.cv))
                             .head(draft.fit_samples));
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<VectorXd> others = parts;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    least = std::min(least, evidence(noise, parts[i], others));
  }
  return least;
}

}  // namespace mpm::hidden
