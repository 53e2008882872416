#pragma once

#include <Eigen/Core>

namespace mpm {

/// Upper triangle of a QR without Q; the last column is a right-hand side. Columns that are zero in
/// most rows cost least in front.
[[nodiscard]] Eigen::MatrixXd triangle(const Eigen::MatrixXd& matrix);

}  // namespace mpm
