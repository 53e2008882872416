#include "core/identification/residual_tests.hpp"

#include <Eigen/QR>
#include <cmath>

#include "core/identification/calibration.hpp"
#include "core/identification/high_order.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double whiteness_p_value(const PredictionErrorFit& fit) {
  const VectorXd innovations = fit.innovations.cwiseProduct(fit.weights);
  const double square = innovations.squaredNorm(), rows = fit.rows;
  const auto order = static_cast<int>(fit.noise.coefficients.size());
  const int lags = order + kWhitenessLags;
  if (!(square > 0.0) || rows <= 2.0 * lags) return 1.0;
  double sum = 0.0;
  for (int lag = 1; lag <= lags; ++lag) {
    const Index count = innovations.size() - lag;
    const double r = innovations.tail(count).dot(innovations.head(count)) / square;
    sum += r * r / (rows - lag);
  }
  const double statistic = rows * (rows + 2.0) * sum;
  return f_upper_tail(statistic / kWhitenessLags, kWhitenessLags, rows);
}

double past_input_p_value(const IdentificationData& data, const PredictionErrorFit& fit,
                          int input) {
  const int longest =
      std::max(2, static_cast<int>(std::min(static_cast<double>(kLongestTestedLag),
                                            kLagShare * static_cast<double>(data.samples()))));
  const MatrixXd sums = lagged_sums(data.inputs.col(input), lag_blocks(longest), data.runs);
  const Index known = fit.slopes.cols(), added = sums.cols();
  MatrixXd system(data.samples(), 1 + known + added + 1);
  system.col(0) = fit.weights;
  system.middleCols(1, known) = fit.slopes;
  for (Index b = 0; b < added; ++b)
    system.col(1 + known + b) = fit.noise.apply(sums.col(b)).cwiseProduct(fit.weights);
  system.rightCols(1) = fit.innovations;
  const VectorXd sizes = system.colwise().norm().cwiseMax(kNotZero);
  system *= sizes.cwiseInverse().asDiagonal();
  const Eigen::HouseholderQR<MatrixXd> qr(system);
  const VectorXd rotated = qr.matrixQR().col(system.cols() - 1).head(system.cols());
  const VectorXd left = qr.matrixQR().diagonal().cwiseAbs();
  double explained = 0.0, count = 0.0;
  for (Index c = 1 + known; c < 1 + known + added; ++c) {
    if (left(c) < kDependent) continue;
    explained += rotated(c) * rotated(c);
    count += 1.0;
  }
  const double rest = rotated(system.cols() - 1) * rotated(system.cols() - 1);
  const double freedom = fit.rows - static_cast<double>(system.cols() - 1);
  if (count == 0.0 || freedom < 1.0 || !(rest > 0.0)) return 1.0;
  return f_upper_tail(explained / count / (rest / freedom), count, freedom);
}

}  // namespace mpm
