#include "core/identify/fit/misfit_slope.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd misfit_slope(const CvData& data, const CvFit& fit) {
  // The innovations, filtered backwards in time.
  const VectorXd weighted = fit.innovations.cwiseProduct(data.weights) / fit.variance;
  const VectorXd& a = fit.noise.coefficients;
  const Index rows = weighted.size();
  VectorXd slope = weighted;
  for (Index l = 1; l <= a.size() && l < rows; ++l)
    slope.head(rows - l) -= a(l - 1) * weighted.tail(rows - l);
  return slope.cwiseProduct(data.known);
}

}  // namespace mpm
