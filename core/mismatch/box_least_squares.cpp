#include "core/mismatch/box_least_squares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/mismatch/calibration.hpp"

namespace mpm {
namespace {

// Least squares over the free entries of x (others as given): Gram-Schmidt on the free columns.
void solve_free(const Eigen::Matrix3d& r, const Eigen::Vector3d& c, const std::array<bool, 3>& free,
                Eigen::Vector3d& x) {
  Eigen::Vector3d rest = c;
  for (int k = 0; k < 3; ++k)
    if (!free[static_cast<std::size_t>(k)]) rest -= x(k) * r.col(k);
  std::array<Eigen::Vector3d, 3> basis;
  Eigen::Matrix3d triangle = Eigen::Matrix3d::Zero();
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();
  std::array<int, 3> at{};
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    if (!free[static_cast<std::size_t>(k)]) continue;
    Eigen::Vector3d column = r.col(k);
    const double size = column.norm();
    for (int pass = 0; pass < 2; ++pass)
      for (int b = 0; b < count; ++b) {
        const auto s = static_cast<std::size_t>(b);
        const double share = basis[s].dot(column);
        triangle(b, count) += share;
        column -= share * basis[s];
      }
    const double own = column.norm();
    if (!(own > calibration::rounding::kFreeShare *
                    size)) {  // explained by the others: not free after all
      x(k) = 0.0;
      triangle.col(count).setZero();
      continue;
    }
    triangle(count, count) = own;
    basis[static_cast<std::size_t>(count)] = column / own;
    shares(count) = basis[static_cast<std::size_t>(count)].dot(rest);
    at[static_cast<std::size_t>(count)] = k;
    ++count;
  }
  for (int b = count - 1; b >= 0; --b) {
    double value = shares(b);
    for (int a = b + 1; a < count; ++a)
      value -= triangle(b, a) * x(at[static_cast<std::size_t>(a)]);
    x(at[static_cast<std::size_t>(b)]) = value / triangle(b, b);
  }
}

}  // namespace

BoxSolution box_least_squares(const Eigen::Matrix3d& r, const Eigen::Vector3d& c,
                              const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  BoxSolution best;
  best.distance_square = std::numeric_limits<double>::infinity();
  for (int combination = 0; combination < 27; ++combination) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    std::array<bool, 3> free{};
    int digits = combination;
    for (int k = 0; k < 3; ++k, digits /= 3) {
      free[static_cast<std::size_t>(k)] = digits % 3 == 0;
      if (digits % 3 == 1) x(k) = low(k);
      if (digits % 3 == 2) x(k) = high(k);
    }
    solve_free(r, c, free, x);
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside = inside && x(k) >= low(k) && x(k) <= high(k);
    if (!inside) continue;
    const double square = (c - r * x).squaredNorm();
    if (square < best.distance_square) best = {x, square};
  }
  return best;
}

}  // namespace mpm
