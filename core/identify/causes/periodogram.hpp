#pragma once

#include <Eigen/Core>
#include <vector>

namespace mpm {

/// |sum_k values(k) e^{-i angle k}|^2, by the recursion of Goertzel (1958).
[[nodiscard]] double power_at(const Eigen::Ref<const Eigen::VectorXd>& values, double angle);

/// Of the numbers of cycles in the data from `fewest` to below `most`, the `count` with the most
/// power, loudest first.
[[nodiscard]] std::vector<int> loudest_cycles(const Eigen::Ref<const Eigen::VectorXd>& values,
                                              int fewest, int most, std::size_t count);

}  // namespace mpm
