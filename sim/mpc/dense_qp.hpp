#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace mpm::sim {

enum class QpStatus : std::uint8_t { kOptimal, kInfeasible, kIterationLimit };

/// min 1/2 x'Hx + f'x  subject to  lower <= A x <= upper, H symmetric positive definite, n
/// variables, m rows. Infinite bounds are no bounds; equal bounds make an equation.
///
/// Dual active-set method of Goldfarb and Idnani (Mathematical Programming 27, 1983): starts from
/// the unconstrained optimum and takes in one violated row at a time, the worst first, keeping all
/// multipliers admissible. With H = L L' and the active normals N (n x q) it carries
/// J = L^-T Q and the triangle R with J'N = [R; 0], both updated by plane rotations. H and A are
/// fixed, so L^-T is found once; f and the bounds change from call to call.
///
/// Rows are scaled to unit length first. Then, with eps the machine precision,
///   a row counts as violated by more than   1e6 eps (1 + |bound| + |x|),
///   a normal a as dependent where           |J2'a| <= 64 n eps |J|_F,
///   a multiplier as able to block where     r > 64 n eps max(1, |r|_inf).
/// Every change of the active set raises the dual objective, so no set can come back; what rounding
/// could still do is caught by the cap of 20 (n + m) changes. A gradient that is not finite gives
/// kIterationLimit, a bound that is not a number kInfeasible. No allocation after construction.
class DenseQp {
 public:
  /// Throws std::invalid_argument if H is not positive definite or sizes differ.
  DenseQp(const Eigen::MatrixXd& hessian, const Eigen::MatrixXd& rows);

  [[nodiscard]] QpStatus solve(const Eigen::Ref<const Eigen::VectorXd>& gradient,
                               const Eigen::Ref<const Eigen::VectorXd>& lower,
                               const Eigen::Ref<const Eigen::VectorXd>& upper);

  /// The optimum after kOptimal; else the last iterate, which violates some row.
  [[nodiscard]] const Eigen::VectorXd& solution() const { return x_; }
  /// One per row, H x + f = A' multipliers: positive at an active lower bound, negative at an
  /// upper.
  [[nodiscard]] const Eigen::VectorXd& multipliers() const { return multipliers_; }
  /// Changes of the active set in the last call.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  enum class Step : std::uint8_t { kTaken, kImpossible, kCapped };
  struct Violation {
    Eigen::Index row = -1;
    double side = 1.0;  ///< +1 lower, -1 upper: side * a'x >= side * bound
  };

  [[nodiscard]] bool start(const Eigen::Ref<const Eigen::VectorXd>& gradient,
                           const Eigen::Ref<const Eigen::VectorXd>& lower,
                           const Eigen::Ref<const Eigen::VectorXd>& upper);
  [[nodiscard]] Violation worst_violation();
  [[nodiscard]] Step take_in(const Violation& violation);
  [[nodiscard]] double bound(Eigen::Index row, double side) const;
  void add_active(const Violation& violation, double multiplier);
  void drop_active(Eigen::Index position);
  void refine(const Eigen::Ref<const Eigen::VectorXd>& gradient);
  void publish_multipliers();

  Eigen::Index variables_ = 0;
  Eigen::MatrixXd rows_;            ///< n x m, one unit-length row of A per column
  Eigen::VectorXd row_scale_;       ///< 1 / length, 0 for a row of zeros
  Eigen::MatrixXd inverse_factor_;  ///< L^-T
  double inverse_factor_norm_ = 0.0;
  double dependence_tolerance_ = 0.0;

  // Of the call under way.
  Eigen::VectorXd lower_, upper_;  ///< scaled bounds
  Eigen::VectorXd x_, multipliers_, row_values_;
  Eigen::MatrixXd j_;                                                         ///< n x n
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> r_;  ///< leading q x q
  Eigen::VectorXd d_, direction_, blocking_, scratch_;
  std::vector<Violation> active_;       ///< q entries used
  std::vector<bool> is_active_;         ///< per row
  Eigen::VectorXd active_multipliers_;  ///< >= 0 but for equations
  Eigen::Index active_count_ = 0;
  int iterations_ = 0;
};

}  // namespace mpm::sim
