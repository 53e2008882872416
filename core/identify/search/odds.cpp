#include "core/identify/search/odds.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/search/calibration.hpp"

namespace mpm {

using Eigen::Index;

double independence(const std::vector<CvFit>& cvs) {
  double product = 0.0, square = 0.0;
  for (const CvFit& state : cvs) {
    const Index rows = state.innovations.size() - 1;
    product += state.innovations.head(rows).dot(state.innovations.tail(rows)) / state.variance;
    square += state.innovations.squaredNorm() / state.variance;
  }
  const double correlation = square > 0.0 ? std::max(0.0, product / square) : 0.0;
  return correlation < kIndependent ? 1.0 : (1.0 - correlation) / (1.0 + correlation);
}

double odds_for(const Effect& effect, const Fit& with, const Fit& without) {
  if (!std::isfinite(with.cost)) return -1e300;
  return independence(with.cvs) * (without.misfit - with.misfit) + without.complexity -
         with.complexity - effect.search_cost - cause_of(effect).rarity();
}

}  // namespace mpm
