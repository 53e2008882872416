#pragma once

#include <Eigen/Core>

namespace mpm {

/// min |c - R x|^2 over the box low <= x <= high, R upper triangular with 3 columns, by looking at
/// each of the 27 ways in which the bounds can hold. Exact; columns with a zero diagonal are held
/// at the bound nearest to 0 of theirs.
struct BoxSolution {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double distance_square = 0.0;
};
[[nodiscard]] BoxSolution box_least_squares(const Eigen::Matrix3d& r, const Eigen::Vector3d& c,
                                            const Eigen::Vector3d& low,
                                            const Eigen::Vector3d& high);

}  // namespace mpm
