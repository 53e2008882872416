#include "core/mismatch/slow_noise.hpp"

#include <algorithm>

namespace mpm {

// The columns take the share few / own of the noise's variance with them, so that the error is
// few / (1 - few / own).
double slow_noise_ratio(double own, double slow_columns, double rows) {
  constexpr int kMost = 3;                               // beyond, nobody knows how slow it is
  const double few = 2.0 * (slow_columns + 1.0) / rows;  // and the past itself
  const double left = own - 2.0 * few;
  return left > 0.0 ? std::min<double>(kMost, (own - few) / left) : kMost;
}

}  // namespace mpm
