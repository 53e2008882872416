#include "sim/mpc/dense_qp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/regression/rotation.hpp"

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

DenseQp::DenseQp(const MatrixXd& hessian, const MatrixXd& rows)
    : variables_(hessian.rows()),
      rows_(rows.transpose()),
      row_scale_(VectorXd::Zero(rows.rows())),
      dependence_tolerance_(64.0 * kEpsilon * static_cast<double>(variables_)),
      lower_(rows.rows()),
      upper_(rows.rows()),
      x_(VectorXd::Zero(variables_)),
      multipliers_(VectorXd::Zero(rows.rows())),
      row_values_(rows.rows()),
      j_(variables_, variables_),
      r_(variables_, variables_),
      d_(variables_),
      direction_(variables_),
      blocking_(variables_),
      scratch_(variables_),
      active_(static_cast<std::size_t>(variables_)),
      is_active_(static_cast<std::size_t>(rows.rows())),
      active_multipliers_(VectorXd::Zero(variables_)) {
  if (hessian.cols() != variables_ || rows.cols() != variables_)
    throw std::invalid_argument("quadratic program: matrix sizes do not match");
  if (!rows.allFinite()) throw std::invalid_argument("quadratic program: rows must be finite");
  const Eigen::LLT<MatrixXd> factor(hessian);
  if (!hessian.allFinite() || factor.info() != Eigen::Success)
    throw std::invalid_argument("quadratic program: the Hessian is not positive definite");
  inverse_factor_ = MatrixXd::Identity(variables_, variables_);
  factor.matrixU().solveInPlace(inverse_factor_);
  inverse_factor_norm_ = inverse_factor_.norm();
  for (Index row = 0; row < rows_.cols(); ++row) {
    const double length = rows_.col(row).stableNorm();
    if (length == 0.0) continue;
    row_scale_(row) = 1.0 / length;
    rows_.col(row) *= row_scale_(row);
  }
}

QpStatus DenseQp::solve(const Ref<const VectorXd>& gradient, const Ref<const VectorXd>& lower,
                        const Ref<const VectorXd>& upper) {
  if (!start(gradient, lower, upper)) return QpStatus::kInfeasible;
  while (true) {
    if (!x_.allFinite()) return QpStatus::kIterationLimit;
    const Violation violation = worst_violation();
    if (violation.row < 0) break;
    const Step step = take_in(violation);
    if (step == Step::kImpossible) return QpStatus::kInfeasible;
    if (step == Step::kCapped) return QpStatus::kIterationLimit;
    refine(gradient);
  }
  publish_multipliers();
  return QpStatus::kOptimal;
}

/// The unconstrained optimum with nothing active. False where the bounds contradict themselves.
bool DenseQp::start(const Ref<const VectorXd>& gradient, const Ref<const VectorXd>& lower,
                    const Ref<const VectorXd>& upper) {
  active_count_ = 0;
  iterations_ = 0;
  multipliers_.setZero();
  std::fill(is_active_.begin(), is_active_.end(), false);
  j_ = inverse_factor_;
  scratch_.noalias() = j_.transpose() * gradient;
  x_.noalias() = j_ * scratch_;
  x_ = -x_;
  for (Index row = 0; row < lower_.size(); ++row) {
    if (!(lower(row) <= upper(row))) return false;
    if (row_scale_(row) == 0.0) {  // 0 within its bounds or never
      if (lower(row) > 0.0 || upper(row) < 0.0) return false;
      lower_(row) = -kInfinity;
      upper_(row) = kInfinity;
      continue;
    }
    lower_(row) = lower(row) * row_scale_(row);
    upper_(row) = upper(row) * row_scale_(row);
  }
  return true;
}

DenseQp::Violation DenseQp::worst_violation() {
  row_values_.noalias() = rows_.transpose() * x_;
  const double tolerance = 1e6 * kEpsilon;
  const double allowance = 1.0 + x_.norm();
  Violation worst;
  double largest = 0.0;
  for (Index row = 0; row < row_values_.size(); ++row) {
    if (is_active_[static_cast<std::size_t>(row)]) continue;
    const double below = lower_(row) - row_values_(row);
    const double above = row_values_(row) - upper_(row);
    const double side = below > above ? 1.0 : -1.0;
    const double size = std::max(below, above);
    if (size > largest && size > tolerance * (allowance + std::abs(bound(row, side)))) {
      largest = size;
      worst = {row, side};
    }
  }
  return worst;
}

double DenseQp::bound(Index row, double side) const {
  return side > 0.0 ? lower_(row) : upper_(row);
}

/// Moves along the dual until the violated row holds with equality, dropping active rows whose
/// multiplier would change sign on the way (Goldfarb and Idnani 1983, section 3, step 2).
DenseQp::Step DenseQp::take_in(const Violation& violation) {
  const double target = violation.side * bound(violation.row, violation.side);
  const auto normal = rows_.col(violation.row);
  const int cap = 20 * static_cast<int>(variables_ + rows_.cols());
  double multiplier = 0.0;
  while (iterations_++ < cap) {
    const Index q = active_count_;
    const Index free = variables_ - q;
    d_.noalias() = j_.transpose() * normal;
    d_ *= violation.side;
    const double curvature = d_.tail(free).squaredNorm();
    const bool dependent = std::sqrt(curvature) <= dependence_tolerance_ * inverse_factor_norm_;

    blocking_.head(q) = d_.head(q);
    r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solveInPlace(blocking_.head(q));
    const double largest = q > 0 ? blocking_.head(q).cwiseAbs().maxCoeff() : 0.0;
    const double threshold = dependence_tolerance_ * std::max(1.0, largest);
    double dual_step = kInfinity;
    Index dropped = -1;
    for (Index i = 0; i < q; ++i) {
      const Index row = active_[static_cast<std::size_t>(i)].row;
      if (blocking_(i) <= threshold || lower_(row) == upper_(row)) continue;
      const double ratio = std::max(0.0, active_multipliers_(i)) / blocking_(i);
      if (ratio < dual_step) {
        dual_step = ratio;
        dropped = i;
      }
    }

    double primal_step = kInfinity;
    if (!dependent) {
      const double missing = target - violation.side * normal.dot(x_);
      primal_step = std::max(0.0, missing) / curvature;
    }
    if (dropped < 0 && dependent) return Step::kImpossible;

    const double step = std::min(dual_step, primal_step);
    active_multipliers_.head(q) -= step * blocking_.head(q);
    multiplier += step;
    if (!dependent) {
      direction_.noalias() = j_.rightCols(free) * d_.tail(free);
      x_ += step * direction_;
    }
    if (primal_step <= dual_step) {
      add_active(violation, multiplier);
      return Step::kTaken;
    }
    drop_active(dropped);
  }
  return Step::kCapped;
}

/// Turns the free part of d = J'n into one entry, which becomes the new column of R.
void DenseQp::add_active(const Violation& violation, double multiplier) {
  const Index q = active_count_;
  for (Index i = variables_ - 1; i > q; --i) {
    if (d_(i) == 0.0) continue;
    const Rotation rotation = make_rotation(d_(i - 1), d_(i));
    d_(i - 1) = rotation.radius;
    rotate_rows(j_.col(i - 1).data(), j_.col(i).data(), static_cast<std::size_t>(variables_),
                rotation);
  }
  r_.col(q).head(q + 1) = d_.head(q + 1);
  active_[static_cast<std::size_t>(q)] = violation;
  is_active_[static_cast<std::size_t>(violation.row)] = true;
  active_multipliers_(q) = multiplier;
  ++active_count_;
}

/// Takes one column out of R and makes R triangular again.
void DenseQp::drop_active(Index position) {
  is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)].row)] = false;
  --active_count_;
  for (Index i = position; i < active_count_; ++i) {
    active_[static_cast<std::size_t>(i)] = active_[static_cast<std::size_t>(i + 1)];
    active_multipliers_(i) = active_multipliers_(i + 1);
    r_.col(i).head(i + 2) = r_.col(i + 1).head(i + 2);
  }
  for (Index i = position; i < active_count_; ++i) {
    const Rotation rotation = make_rotation(r_(i, i), r_(i + 1, i));
    rotate_rows(&r_(i, i), &r_(i + 1, i), static_cast<std::size_t>(active_count_ - i), rotation);
    rotate_rows(j_.col(i).data(), j_.col(i + 1).data(), static_cast<std::size_t>(variables_),
                rotation);
  }
}

/// x and multipliers straight from the active set, free of the rounding of the steps that led
/// there, which may have started from a far larger x. N'x = b gives R'w = b, then x = J1 w - J2
/// J2'f and R u = w + J1'f.
void DenseQp::refine(const Ref<const VectorXd>& gradient) {
  const Index q = active_count_;
  const Index free = variables_ - q;
  for (Index i = 0; i < q; ++i) {
    const Violation& active = active_[static_cast<std::size_t>(i)];
    d_(i) = active.side * bound(active.row, active.side);
  }
  r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().transpose().solveInPlace(d_.head(q));
  scratch_.noalias() = j_.transpose() * gradient;
  d_.tail(free) = -scratch_.tail(free);
  x_.noalias() = j_ * d_;
  active_multipliers_.head(q) = d_.head(q) + scratch_.head(q);
  r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solveInPlace(active_multipliers_.head(q));
}

void DenseQp::publish_multipliers() {
  for (Index i = 0; i < active_count_; ++i) {
    const Violation& active = active_[static_cast<std::size_t>(i)];
    const bool equation = lower_(active.row) == upper_(active.row);
    const double value = equation ? active_multipliers_(i) : std::max(0.0, active_multipliers_(i));
    multipliers_(active.row) = active.side * value * row_scale_(active.row);
  }
}

}  // namespace mpm::sim
