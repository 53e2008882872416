#include "core/mismatch/materiality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mismatch/box_least_squares.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/mismatch/signature.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool surely_within(const Estimate& estimate, double limit) {
  return std::abs(estimate.value) + kNormalOneSided95 * estimate.deviation < limit;
}

}  // namespace

double Materiality::beyond(const Estimate& estimate, double limit, double freedom) {
  const double excess = (std::abs(estimate.value) - limit) / estimate.deviation;
  return excess > 0.0 ? 0.5 * f_upper_tail(excess * excess, 1.0, freedom) : 1.0;
}

Materiality::Materiality(int block)
    : reduction_(std::max(block, kUsualErrors)),
      beside_allowed_(Eigen::VectorXd::Zero(std::max(block, kUsualErrors))),
      usual_directions_(Eigen::MatrixXd::Zero(kUsualErrors, error_column::kCount)),
      usual_estimate_(Eigen::VectorXd::Zero(kUsualErrors)) {}

bool Materiality::explained(double left, Eigen::Index block, const EstimateNoise& noise) {
  const auto free = static_cast<double>(block - 3);
  return free > 0.0 && f_upper_tail(left / (free * noise.variance), free, noise.freedom) >
                           calibration::usual_errors::kUnusualPValue;
}

void Materiality::judge(double left, const Eigen::VectorXd& estimate,
                        const Eigen::MatrixXd& directions, const UsualErrorSpace& usual,
                        const MaterialityLimits& limits, const EstimateNoise& noise,
                        ChannelEvidence& evidence) {
  evidence.usual = explained(left, estimate.size(), noise);
  beside_allowed_.head(estimate.size()) = estimate;
  if (evidence.usual)
    judge_usual(limits, noise, evidence);
  else
    judge_unusual(estimate, directions, usual, limits, noise, evidence);
}

double Materiality::fit(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& directions,
                        const EstimateNoise& noise, ChannelEvidence& evidence) {
  double nearest = kInfinity;
  for (const int shift : {error_column::kLater, error_column::kEarlier}) {
    const ReducedErrors whole = reduction_.reduce(estimate, directions, shift);
    // Without dead time a lag cannot answer earlier: that would be the same lag with more gain, but
    // for rounding.
    if (shift == error_column::kEarlier && (evidence.dead_time == 0.0 || whole.r(2, 2) == 0.0))
      continue;
    const Eigen::Vector3d fit = whole.fit();
    const double square = whole.rest_square + (whole.c - whole.r * fit).squaredNorm();
    if (square >= nearest) continue;
    nearest = square;
    fitted_ = whole;
    fitted_shift_ = shift;
    const Eigen::Vector3d deviations = std::sqrt(noise.variance) * whole.deviations();
    evidence.gain_error = {fit(0), deviations(0)};
    evidence.log_time_error = {fit(1), deviations(1)};
    evidence.dead_time_error = {shift == error_column::kLater ? fit(2) : -fit(2), deviations(2)};
  }
  return nearest;
}

void Materiality::judge_usual(const MaterialityLimits& limits, const EstimateNoise& noise,
                              ChannelEvidence& evidence) {
  constexpr double kTests = 3.0;
  const double log_time = std::log1p(limits.time_constant);
  const double most =
      std::min({beyond(evidence.gain_error, limits.gain, noise.freedom),
                beyond(evidence.log_time_error, log_time, noise.freedom),
                beyond(evidence.dead_time_error, limits.dead_time_samples, noise.freedom)});
  evidence.p_value_material = std::min(1.0, kTests * most);
  evidence.harmless = surely_within(evidence.gain_error, limits.gain) &&
                      surely_within(evidence.log_time_error, log_time) &&
                      surely_within(evidence.dead_time_error, limits.dead_time_samples);
}

void Materiality::judge_unusual(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& directions,
                                const UsualErrorSpace& usual, const MaterialityLimits& limits,
                                const EstimateNoise& noise, ChannelEvidence& evidence) {
  constexpr double kTests = 2.0;
  const int rank = usual.rank();
  for (int d = 0; d < error_column::kCount; ++d)
    usual.coordinates(directions.col(d), usual_directions_.col(d));
  usual.coordinates(estimate, usual_estimate_);
  const double log_time = std::log1p(limits.time_constant);
  const Eigen::Vector3d low(-limits.gain, -log_time, 0.0);
  const Eigen::Vector3d high(limits.gain, log_time, limits.dead_time_samples);
  double nearest = kInfinity;
  double nearest_usual = kInfinity;
  for (const int shift : {error_column::kLater, error_column::kEarlier}) {
    const ReducedErrors whole = reduction_.reduce(estimate, directions, shift);
    const BoxSolution allowed = box_least_squares(whole.r, whole.c, low, high);
    if (whole.rest_square + allowed.distance_square < nearest) {
      nearest = whole.rest_square + allowed.distance_square;
      auto left = beside_allowed_.head(estimate.size());
      left = estimate - allowed.x(2) * directions.col(shift);
      for (const int d : {error_column::kGain, error_column::kTime})
        left -= allowed.x(d) * directions.col(d);
    }
    const ReducedErrors part =
        reduction_.reduce(usual_estimate_.head(rank), usual_directions_.topRows(rank), shift);
    nearest_usual =
        std::min(nearest_usual,
                 part.rest_square + box_least_squares(part.r, part.c, low, high).distance_square);
  }
  const auto block = static_cast<double>(estimate.size());
  const double block_p =
      f_upper_tail(nearest / (block * noise.block_variance), block, noise.freedom);
  const double usual_p = f_upper_tail(nearest_usual / (rank * noise.variance), rank, noise.freedom);
  evidence.p_value_material = std::min(1.0, kTests * std::min(block_p, usual_p));
}

}  // namespace mpm
