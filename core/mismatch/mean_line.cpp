#include "core/mismatch/mean_line.hpp"

namespace mpm {

double mean_line(const LaggedCorrelation& correlation) {
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < correlation.inputs(); ++i) {
    if (!correlation.defined(i)) continue;
    for (int j = 0; j < correlation.cvs(); ++j)
      sum += correlation.correlations(j, i).cwiseAbs().sum();
    count += correlation.cvs() * correlation.lag_count();
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace mpm
