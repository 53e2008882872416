#include "tests/sim/mpc/ipopt_oracle.hpp"

#if defined(MPM_HAVE_IPOPT)

#include <IpStdCInterface.h>

#include <algorithm>
#include <vector>

namespace mpm::test {
namespace {

using ConstMap = Eigen::Map<const Eigen::VectorXd>;
using Map = Eigen::Map<Eigen::VectorXd>;

const QpProblem& problem_of(UserDataPtr data) { return *static_cast<const QpProblem*>(data); }

Bool cost(Index n, Number* x, Bool, Number* value, UserDataPtr data) {
  *value = problem_of(data).cost(ConstMap(x, n));
  return 1;
}

Bool gradient(Index n, Number* x, Bool, Number* values, UserDataPtr data) {
  const QpProblem& problem = problem_of(data);
  Map(values, n) = problem.hessian * ConstMap(x, n) + problem.gradient;
  return 1;
}

Bool rows(Index n, Number* x, Bool, Index m, Number* values, UserDataPtr data) {
  Map(values, m) = problem_of(data).rows * ConstMap(x, n);
  return 1;
}

Bool jacobian(Index n, Number*, Bool, Index m, Index, Index* row, Index* column, Number* values,
              UserDataPtr data) {
  Index entry = 0;
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < n; ++j, ++entry) {
      if (values != nullptr) {
        values[entry] = problem_of(data).rows(i, j);
      } else {
        row[entry] = i;
        column[entry] = j;
      }
    }
  }
  return 1;
}

Bool hessian(Index n, Number*, Bool, Number factor, Index, Number*, Bool, Index, Index* row,
             Index* column, Number* values, UserDataPtr data) {
  Index entry = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j <= i; ++j, ++entry) {
      if (values != nullptr) {
        values[entry] = factor * problem_of(data).hessian(i, j);
      } else {
        row[entry] = i;
        column[entry] = j;
      }
    }
  }
  return 1;
}

std::vector<double> limited(const Eigen::VectorXd& bounds) {
  constexpr double kIpoptInfinity = 2e19;
  std::vector<double> result(bounds.begin(), bounds.end());
  for (double& bound : result) bound = std::clamp(bound, -kIpoptInfinity, kIpoptInfinity);
  return result;
}

}  // namespace

std::optional<OracleAnswer> solve_with_ipopt(const QpProblem& problem) {
  const auto n = static_cast<Index>(problem.gradient.size());
  const auto m = static_cast<Index>(problem.lower.size());
  std::vector<double> free_low(static_cast<std::size_t>(n), -2e19);
  std::vector<double> free_high(static_cast<std::size_t>(n), 2e19);
  std::vector<double> lower = limited(problem.lower), upper = limited(problem.upper);
  IpoptProblem ipopt =
      CreateIpoptProblem(n, free_low.data(), free_high.data(), m, lower.data(), upper.data(), n * m,
                         n * (n + 1) / 2, 0, cost, rows, gradient, jacobian, hessian);
  // The C interface of this version takes names as char*.
  const auto text = [](const char* value) { return const_cast<char*>(value); };
  AddIpoptIntOption(ipopt, text("print_level"), 0);
  AddIpoptStrOption(ipopt, text("sb"), text("yes"));
  AddIpoptStrOption(ipopt, text("hessian_constant"), text("yes"));
  AddIpoptStrOption(ipopt, text("jac_d_constant"), text("yes"));
  AddIpoptStrOption(ipopt, text("jac_c_constant"), text("yes"));
  AddIpoptNumOption(ipopt, text("tol"), 1e-10);
  AddIpoptNumOption(ipopt, text("bound_relax_factor"), 0.0);
  OracleAnswer answer;
  answer.x = Eigen::VectorXd::Zero(n);
  double value = 0.0;
  QpProblem copy = problem;
  const ApplicationReturnStatus status =
      IpoptSolve(ipopt, answer.x.data(), nullptr, &value, nullptr, nullptr, nullptr, &copy);
  answer.solved = status == Solve_Succeeded || status == Solved_To_Acceptable_Level;
  answer.infeasible = status == Infeasible_Problem_Detected;
  FreeIpoptProblem(ipopt);
  return answer;
}

}  // namespace mpm::test

#else

namespace mpm::test {
std::optional<OracleAnswer> solve_with_ipopt(const QpProblem&) { return std::nullopt; }
}  // namespace mpm::test

#endif
