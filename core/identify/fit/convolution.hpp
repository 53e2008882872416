#pragma once

#include <Eigen/Core>

namespace mpm {

/// What a channel with this impulse response gives: y(k) = sum over l >= 1 of h(l) x(k - l), where
/// x was x_before at all times before row 0. By fast Fourier transform: rounding is that of the
/// largest values. `response`: h(1), h(2), ...
[[nodiscard]] Eigen::VectorXd convolved(const Eigen::Ref<const Eigen::VectorXd>& response,
                                        const Eigen::Ref<const Eigen::VectorXd>& x,
                                        double x_before);

}  // namespace mpm
