#include "core/identify/fit/noise_before.hpp"

#include <algorithm>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/row_weights.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd noise_before(const Eigen::Ref<const VectorXd>& residual,
                      const Eigen::Ref<const VectorXd>& known, const std::vector<Run>& runs,
                      const NoiseModel& noise) {
  const VectorXd weights = rows_with_past(known, runs, noise.order);
  VectorXd innovations =
      fit_whitening(residual, weights, noise).apply(residual).cwiseProduct(weights);
  const double most = kClip * usual_sd(innovations, weights);
  innovations = innovations.cwiseMin(most).cwiseMax(-most);
  MatrixXd before = MatrixXd::Zero(residual.size(), static_cast<Index>(kNoiseBeforePoles.size()));
  for (const auto& [first, count] : runs)
    for (Index k = first + 1; k < first + count; ++k)
      for (std::size_t p = 0; p < kNoiseBeforePoles.size(); ++p) {
        const double pole = kNoiseBeforePoles[p];
        const auto column = static_cast<Index>(p);
        before(k, column) = pole * before(k - 1, column) + (1.0 - pole) * innovations(k - 1);
      }
  return before;
}

}  // namespace mpm
