#include "core/model/filter_channel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "core/model/calibration.hpp"
#include "core/model/eigenvalues.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check(const DiscreteFilter& filter) {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (filter.numerator.empty() || filter.denominator.empty() || filter.denominator[0] == 0.0)
    throw std::invalid_argument("filter: numerator and a non-zero leading denominator expected");
  if (!std::all_of(filter.numerator.begin(), filter.numerator.end(), finite) ||
      !std::all_of(filter.denominator.begin(), filter.denominator.end(), finite))
    throw std::invalid_argument("filter: coefficients must be finite");
  if (filter.delay_samples < 0 || filter.delay_samples > calibration::kLongestDeadTime)
    throw std::invalid_argument("filter: delay must be in 0 .. 1e6 samples");
}

ChannelFacts facts_of(const FilterChannel& filter) {
  const VectorXd& b = filter.numerator;
  const VectorXd& a = filter.denominator;
  const Index order = b.size() - 1;
  ChannelFacts result;
  result.order = order;
  result.dead_time = filter.delay;
  for (Index i = 0; i < b.size() && b(i) == 0.0; ++i) result.dead_time += 1.0;
  result.integrating = std::abs(a.sum()) <= calibration::model_rounding::kSame * a.cwiseAbs().sum();
  double radius = 0.0;
  Index poles = order;  // those at 0 decide nothing
  while (poles > 0 && a(poles) == 0.0) --poles;
  if (poles > 0) {
    MatrixXd companion = MatrixXd::Zero(poles, poles);
    companion.row(0) = -a.segment(1, poles).transpose();
    companion.bottomLeftCorner(poles - 1, poles - 1).setIdentity();
    for (const std::complex<double>& pole : companion.eigenvalues()) {
      if (result.integrating && std::abs(pole - 1.0) < calibration::model_rounding::kSameRoot)
        continue;
      if (std::abs(pole) >= 1.0) result.unstable = true;
      radius = std::max(radius, std::abs(pole));
    }
  }
  result.slowest = result.unstable ? 1.0 : slowest_from_radius(radius);

  // With a simple pole at 1, A(q) = (1 - q) A1(q) and A1(1) = -A'(1): the output ramps.
  const double slope_denominator =
      -a.dot(VectorXd::LinSpaced(order + 1, 0.0, static_cast<double>(order)));
  result.gain = result.integrating ? b.sum() / slope_denominator : b.sum() / a.sum();
  return result;
}

/// The states after an input of 1 held for ever, y(k-j) = level - slope j.
void set_rest(FilterChannel& filter, const ChannelFacts& facts) {
  const Index order = filter.numerator.size() - 1;
  const double level = facts.integrating ? 0.0 : facts.gain;
  const double slope = facts.integrating ? facts.gain : 0.0;
  filter.rest(0) = level;
  for (Index i = 1; i <= order; ++i)
    for (Index m = i; m <= order; ++m)
      filter.rest(i) += filter.numerator(m) -
                        filter.denominator(m) * (level - slope * static_cast<double>(m - i));
}

}  // namespace

DescribedFilter make_filter_channel(int cv, int source, const DiscreteFilter& filter,
                                    Index first_state) {
  check(filter);
  const auto length =
      static_cast<Index>(std::max(filter.numerator.size(), filter.denominator.size()));
  FilterChannel made{cv,
                     source,
                     filter.delay_samples,
                     VectorXd::Zero(length),
                     VectorXd::Zero(length),
                     VectorXd::Zero(length),
                     first_state};
  for (std::size_t i = 0; i < filter.numerator.size(); ++i)
    made.numerator(static_cast<Index>(i)) = filter.numerator[i] / filter.denominator[0];
  for (std::size_t i = 0; i < filter.denominator.size(); ++i)
    made.denominator(static_cast<Index>(i)) = filter.denominator[i] / filter.denominator[0];
  const ChannelFacts facts = facts_of(made);
  set_rest(made, facts);
  return {std::move(made), facts};
}

}  // namespace mpm
