#pragma once

#include <Eigen/Core>
#include <optional>

namespace mpm::test {

struct QpProblem {
  Eigen::MatrixXd hessian, rows;
  Eigen::VectorXd gradient, lower, upper;

  [[nodiscard]] double cost(const Eigen::VectorXd& x) const {
    return 0.5 * x.dot(hessian * x) + gradient.dot(x);
  }
};

struct OracleAnswer {
  bool solved = false;
  bool infeasible = false;
  Eigen::VectorXd x;
};

/// The same problem solved by Ipopt (interior point, a different method by other people); nothing
/// where this build has no Ipopt.
[[nodiscard]] std::optional<OracleAnswer> solve_with_ipopt(const QpProblem& problem);

}  // namespace mpm::test
