#include "core/identify/search/odds.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

using Eigen::Index;

double rarity(Cause cause) {
  switch (cause) {
    case Cause::kGain:
    case Cause::kDeadTime:
    case Cause::kTimeConstant:
    case Cause::kDynamics:
    case Cause::kInputScale:
    case Cause::kOutputScale:
      return 0.0;
    case Cause::kStateNonlinearity:
      return 2.0 * std::log(24.0);
    case Cause::kUnnamed:  // a name is better than none
      return 2.0 * std::log(1000.0);
    default:
      return 2.0 * std::log(12.0);
  }
}

bool may_pass_for_noise(const Subject& subject) {
  return subject.cause == Cause::kUnmodelledInput || subject.kind == "drift" ||
         subject.kind == "periodic";
}

double independence(const std::vector<CvFit>& cvs) {
  double product = 0.0, square = 0.0;
  for (const CvFit& state : cvs) {
    const Index rows = state.innovations.size() - 1;
    product += state.innovations.head(rows).dot(state.innovations.tail(rows)) / state.variance;
    square += state.innovations.squaredNorm() / state.variance;
  }
  const double correlation = square > 0.0 ? std::max(0.0, product / square) : 0.0;
  return correlation < 0.1 ? 1.0 : (1.0 - correlation) / (1.0 + correlation);
}

double odds_for(const Effect& effect, const Fit& with, const Fit& without) {
  if (!std::isfinite(with.cost)) return -1e300;
  return independence(with.cvs) * (without.misfit - with.misfit) + without.complexity -
         with.complexity - effect.search_cost - rarity(effect.subject.cause);
}

}  // namespace mpm
