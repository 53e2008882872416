#include "core/identify/causes/actuator_moments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identify/fit/misfit_slope.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr Index kActuatorMomentsMargin = 10;  ///< rows at either end
constexpr Index kActuatorMomentsApart = 10;   ///< rows
/// Of a channel's impulse response, samples: enough to find a moment by.
constexpr int kLongestResponse = 1000;

/// What the rows from k on, with the input's move or its unit in them, would take off the misfit
/// (half of it, to first order) and cost themselves.
struct Suffixes {
  VectorXd fall_of_one, fall_of_move;
  VectorXd one_one, one_move, move_move;
};

/// Sum over i, j >= k of x(i) y(j) r(|i - j|) for every k.
VectorXd quadratic(const VectorXd& x, const VectorXd& y, const VectorXd& r) {
  const Index rows = x.size(), lags = r.size();
  VectorXd sum = VectorXd::Zero(rows + 1);
  for (Index k = rows - 1; k >= 0; --k) {
    const Index count = std::min(lags, rows - k);
    const VectorXd::ConstSegmentReturnType weights = r.head(count);
    sum(k) = sum(k + 1) + x(k) * weights.dot(y.segment(k, count)) +
             y(k) * weights.dot(x.segment(k, count)) - x(k) * y(k) * r(0);
  }
  return sum;
}

VectorXd suffix_sums(const VectorXd& values) {
  VectorXd sum = VectorXd::Zero(values.size() + 1);
  for (Index k = values.size() - 1; k >= 0; --k) sum(k) = sum(k + 1) + values(k);
  return sum;
}

/// What is left of a CV by all that was accepted: as the fit without more has it, or plainly. An
/// actuator that sticks while its command runs away is off by so much that the small errors and the
/// noise model of that fit, grown large, hide when it began.
CvFit left(const Outlook& outlook, int cv, bool plainly) {
  CvFit fit = outlook.without[static_cast<std::size_t>(cv)];
  if (!plainly) return fit;
  const CvData& data = outlook.problem.data(cv);
  fit.residual =
      (data.measured - outlook.problem.simulate(outlook.accepted, cv)).cwiseProduct(data.known);
  fit.noise.coefficients.setZero();
  fit.innovations = fit.residual;
  return fit;
}

/// `move`: of the input, samples.
Suffixes suffixes_of(const Outlook& outlook, int input, const VectorXd& move, bool plainly) {
  const Index rows = move.size();
  const LinearModel model(outlook.model());
  const auto longest = static_cast<int>(std::min<Index>(rows, kLongestResponse));
  const int length =
      model.integrating().any() ? longest : std::max(2, model.settling_samples(0.01, longest));
  const VectorXd one = VectorXd::Ones(rows);
  const VectorXd none = VectorXd::Zero(rows + 1);
  Suffixes sums{none, none, none, none, none};
  for (const int cv : outlook.cvs_of(input)) {
    const CvFit fit = left(outlook, cv, plainly);
    const VectorXd slope = misfit_slope(outlook.problem.data(cv), fit);
    const VectorXd response = model.impulse_response(cv, input, length);
    VectorXd fall(rows);
    for (Index k = 0; k < rows; ++k) {
      const Index count = std::min<Index>(length, rows - k);
      fall(k) = response.head(count).dot(slope.segment(k, count));
    }
    const Whitening noise{fit.noise.coefficients, {}};  // the recording's runs are not a response's
    const VectorXd whitened = noise.apply(response) / std::sqrt(fit.variance);
    VectorXd correlation(length);
    for (Index l = 0; l < length; ++l)
      correlation(l) = whitened.head(length - l).dot(whitened.tail(length - l));
    sums.fall_of_one += suffix_sums(fall);
    sums.fall_of_move += suffix_sums(fall.cwiseProduct(move));
    sums.one_one += quadratic(one, one, correlation);
    sums.one_move += quadratic(one, move, correlation);
    sums.move_move += quadratic(move, move, correlation);
  }
  return sums;
}

/// The rows of the largest gains, with what goes with them.
std::vector<ActuatorMoment> best_of(const VectorXd& gain, const VectorXd& value, std::size_t most) {
  std::vector<Index> order(static_cast<std::size_t>(gain.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index x, Index y) { return gain(x) > gain(y); });
  std::vector<ActuatorMoment> best;
  for (const Index k : order) {
    if (best.size() == most || !(gain(k) > 0.0)) break;
    const bool near = std::any_of(best.begin(), best.end(), [&](const ActuatorMoment& other) {
      return std::abs(other.onset - k) < kActuatorMomentsApart;
    });
    if (!near && k >= kActuatorMomentsMargin && k + kActuatorMomentsMargin < gain.size())
      best.push_back({k, value(k)});
  }
  return best;
}

/// Of the input, 0 where it is unknown.
VectorXd moves(const Outlook& outlook, int input, double from) {
  return outlook.recording().inputs.col(input).unaryExpr(
      [from](double u) { return std::isfinite(u) ? u - from : 0.0; });
}

}  // namespace

std::vector<ActuatorMoment> offset_moments(const Outlook& outlook, int input, std::size_t most) {
  const VectorXd move = VectorXd::Zero(outlook.problem.samples());
  const Suffixes sums = suffixes_of(outlook, input, move, false);
  const Index rows = move.size();
  VectorXd gain = VectorXd::Zero(rows), size = VectorXd::Zero(rows);
  for (Index k = 0; k < rows; ++k) {
    if (!(sums.one_one(k) > 0.0)) continue;
    size(k) = sums.fall_of_one(k) / sums.one_one(k);
    gain(k) = size(k) * sums.fall_of_one(k);
  }
  return best_of(gain, size, most);
}

std::vector<ActuatorMoment> stuck_moments(const Outlook& outlook, int input, std::size_t most) {
  const double from = outlook.model().input_origin(input);
  const VectorXd move = moves(outlook, input, from);
  std::vector<ActuatorMoment> found;
  for (const bool plainly : {false, true}) {
    const Suffixes sums = suffixes_of(outlook, input, move, plainly);
    const Index rows = move.size();
    VectorXd gain = VectorXd::Zero(rows), value = VectorXd::Zero(rows);
    for (Index k = 0; k < rows; ++k) {
      if (!(sums.one_one(k) > 0.0)) continue;
      // The change is v - move: what it takes off is quadratic in v.
      const double v = (sums.fall_of_one(k) + sums.one_move(k)) / sums.one_one(k);
      const double fall = v * sums.fall_of_one(k) - sums.fall_of_move(k);
      const double own = v * v * sums.one_one(k) - 2.0 * v * sums.one_move(k) + sums.move_move(k);
      gain(k) = 2.0 * fall - own;
      value(k) = from + v;
    }
    const std::vector<ActuatorMoment> best = best_of(gain, value, most / 2);
    found.insert(found.end(), best.begin(), best.end());
  }
  return found;
}

}  // namespace mpm
