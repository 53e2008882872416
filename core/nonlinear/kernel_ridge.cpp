#include "core/nonlinear/kernel_ridge.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/nonlinear/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

// Moments of s = sum d_i z_i^2 / sum z_i^2 over z normal in `freedom` dimensions: mean D1 / n,
// variance 2 (n D2 - D1^2) / (n^2 (n + 2)), D_k = sum d_i^k; s / d_max as a beta variable of these,
// whose tail is F's.
double score_p_value(const Eigen::VectorXd& values, double statistic, double freedom) {
  const double largest = values.maxCoeff();
  if (!(largest > 0.0)) return 1.0;
  const double first = values.sum() / largest;
  const double second = values.squaredNorm() / (largest * largest);
  const double mean = first / freedom;
  const double variance =
      2.0 * (freedom * second - first * first) / (freedom * freedom * (freedom + 2.0));
  if (!(variance > 0.0 && mean < 1.0)) return 1.0;
  const double total = mean * (1.0 - mean) / variance - 1.0;
  const double a = mean * total, b = (1.0 - mean) * total;
  const double share = statistic / largest;
  if (!(share < 1.0)) return 0.0;
  return f_upper_tail(share / (1.0 - share) * b / a, 2.0 * a, 2.0 * b);
}

}  // namespace

KernelFit fit_kernel(const Eigen::Ref<const Eigen::MatrixXd>& kernel,
                     const Eigen::Ref<const Eigen::MatrixXd>& nuisance,
                     const Eigen::Ref<const Eigen::VectorXd>& response) {
  const Eigen::Index count = response.size();
  if (kernel.rows() != count || kernel.cols() != count || nuisance.rows() != count)
    throw std::invalid_argument("kernel, nuisance and response are of different lengths");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(nuisance);
  const Eigen::Index left = count - factor.rank();
  if (left < 2) throw std::invalid_argument("the nuisance columns leave nothing");
  // The basis of what Z leaves: there QKQ has as many rows as there are degrees of freedom.
  const Eigen::MatrixXd basis = Eigen::MatrixXd(factor.householderQ()).rightCols(left);
  const Eigen::MatrixXd projected = basis.transpose() * kernel * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 *
                                                             (projected + projected.transpose()));
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0.0);
  const Eigen::VectorXd rotated = eigen.eigenvectors().transpose() * (basis.transpose() * response);

  KernelFit fit;
  fit.fitted = Eigen::VectorXd::Zero(count);
  const double square = rotated.squaredNorm();
  const double scale = values.sum() / static_cast<double>(left);
  if (!(square > 0.0 && scale > 0.0)) return fit;
  fit.p_value =
      score_p_value(values, values.dot(rotated.cwiseAbs2()) / square, static_cast<double>(left));
  const double ratio = std::pow(calibration::ridges::kLast / calibration::ridges::kFirst,
                                1.0 / (calibration::ridges::kCount - 1));
  double least = std::numeric_limits<double>::infinity();
  double ridge = calibration::ridges::kFirst * scale;
  for (int r = 0; r < calibration::ridges::kCount; ++r, ridge *= ratio) {
    const Eigen::ArrayXd hat = values.array() / (values.array() + ridge);
    const double freedom = static_cast<double>(left) - hat.sum();
    const double score =
        ((1.0 - hat) * rotated.array()).matrix().squaredNorm() / (freedom * freedom);
    if (!(score < least)) continue;
    least = score;
    fit.ridge = ridge;
    fit.freedom = hat.sum();
    const Eigen::VectorXd shrunk = (hat * rotated.array()).matrix();
    const double norm = shrunk.norm();
    fit.correlation = norm > 0.0 ? shrunk.dot(rotated) / (norm * std::sqrt(square)) : 0.0;
    fit.fitted = basis * (eigen.eigenvectors() * shrunk);
  }
  return fit;
}

}  // namespace mpm
