#pragma once

#include <Eigen/Core>

namespace mpm {

/// Kernel ridge regression of one signal on a kernel, beside linear ones.
struct KernelFit {
  double ridge = 0.0;        ///< that was chosen, >= 0
  double freedom = 0.0;      ///< trace of the hat matrix: how many columns the fit is worth
  double correlation = 0.0;  ///< kernel partial correlation: of the fit with the response, 0..1
  double p_value = 1.0;      ///< that the kernel says nothing, were the errors normal and white
  Eigen::VectorXd fitted;    ///< less what is linear; count values
};

/// The exact form, for few points: of the response y (count values), the nuisance columns Z (count
/// x any, the linear ones with a constant among them) and the kernel matrix K (count x count). With
/// Q what projects Z off,
///
///     fit = H y,   H = QKQ (QKQ + ridge I)^-1,
///
/// by the eigenvectors of QKQ (Saunders, Gammerman and Vovk 1998). The ridge is that of a grid for
/// which generalised cross-validation (Golub, Heath and Wahba 1979) is least. The p-value is of the
/// score statistic y'QKQy / y'Qy, which no ridge enters (Liu, Lin and Ghosh 2007), with a beta
/// distribution of the right mean and variance under the null.
///
/// O(count^3); allocates. Throws std::invalid_argument where shapes do not fit, or Z leaves
/// nothing.
[[nodiscard]] KernelFit fit_kernel(const Eigen::Ref<const Eigen::MatrixXd>& kernel,
                                   const Eigen::Ref<const Eigen::MatrixXd>& nuisance,
                                   const Eigen::Ref<const Eigen::VectorXd>& response);

}  // namespace mpm
