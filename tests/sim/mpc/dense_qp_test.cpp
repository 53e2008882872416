#include "sim/mpc/dense_qp.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/allocation_counter.hpp"
#include "tests/sim/mpc/ipopt_oracle.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mpm::sim::DenseQp;
using mpm::sim::QpStatus;
using mpm::test::OracleAnswer;
using mpm::test::QpProblem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform() { return 2.0 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1.0; }
  Index below(Index count) {
    return static_cast<Index>(engine_() % static_cast<unsigned long>(count));
  }
  MatrixXd matrix(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [this] { return uniform(); });
  }
  VectorXd vector(Index size) { return matrix(size, 1); }

 private:
  std::mt19937_64 engine_;
};

/// Eigenvalues spread evenly in the logarithm over 1 .. condition.
MatrixXd hessian(Random& random, Index n, double condition) {
  const MatrixXd basis =
      Eigen::HouseholderQR<MatrixXd>(random.matrix(n, n)).householderQ() * MatrixXd::Identity(n, n);
  VectorXd values(n);
  for (Index i = 0; i < n; ++i)
    values(i) =
        std::pow(condition, n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0);
  const MatrixXd result = basis * values.asDiagonal() * basis.transpose();
  return 0.5 * (result + result.transpose());
}

/// Feasible at a point drawn first; the bounds pass at or near it, the optimum lies outside.
QpProblem feasible_problem(Random& random, Index n, Index m, double condition) {
  QpProblem problem;
  problem.hessian = hessian(random, n, condition);
  problem.gradient = 5.0 * condition * random.vector(n);
  problem.rows = random.matrix(m, n);
  const VectorXd centre = problem.rows * random.vector(n);
  problem.lower = centre - (random.vector(m).array() + 1.0).matrix();
  problem.upper = centre + (random.vector(m).array() + 1.0).matrix();
  for (Index i = 0; i < m; ++i) {
    const Index kind = random.below(4);
    if (kind == 0) problem.lower(i) = -kInfinity;
    if (kind == 1) problem.upper(i) = kInfinity;
  }
  return problem;
}

/// Repeated, opposite, scaled, dependent and tight rows, and equations: more rows meet in one
/// point than there are dimensions.
QpProblem degenerate_problem(Random& random, Index n, double condition) {
  QpProblem problem = feasible_problem(random, n, 3 * n, condition);
  const Index m = problem.rows.rows();
  const VectorXd vertex = random.vector(n);
  for (Index i = 0; i < m; ++i) {
    if (i > 3) {
      switch (random.below(4)) {
        case 0:
          problem.rows.row(i) = problem.rows.row(random.below(i));
          break;
        case 1:
          problem.rows.row(i) = -1e3 * problem.rows.row(random.below(i));
          break;
        case 2:
          problem.rows.row(i) = problem.rows.row(random.below(i)) + problem.rows.row(0);
          break;
        default:
          break;
      }
    }
    problem.lower(i) = -kInfinity;
    problem.upper(i) = problem.rows.row(i).dot(vertex);  // all through the vertex
    if (i < n / 3) problem.lower(i) = problem.upper(i);  // equations
  }
  return problem;
}

/// Largest violation of the Karush-Kuhn-Tucker conditions, each relative to the size of its terms.
/// They are sufficient for the optimum of a convex problem.
double kkt_error(const QpProblem& problem, const DenseQp& qp) {
  const VectorXd& x = qp.solution();
  const VectorXd& multipliers = qp.multipliers();
  const VectorXd values = problem.rows * x;
  const double gradient_scale =
      1.0 + problem.gradient.norm() + (problem.hessian * x).norm() +
      (problem.rows.cwiseAbs().transpose() * multipliers.cwiseAbs()).norm();
  double error = (problem.hessian * x + problem.gradient - problem.rows.transpose() * multipliers)
                     .cwiseAbs()
                     .maxCoeff() /
                 gradient_scale;
  for (Index i = 0; i < values.size(); ++i) {
    const double length = problem.rows.row(i).norm();
    const double scale = length * (1.0 + x.norm());
    error = std::max(error, (problem.lower(i) - values(i)) / scale);
    error = std::max(error, (values(i) - problem.upper(i)) / scale);
    if (multipliers(i) > 0.0)
      error = std::max(error, std::abs(values(i) - problem.lower(i)) / scale);
    if (multipliers(i) < 0.0)
      error = std::max(error, std::abs(values(i) - problem.upper(i)) / scale);
  }
  return error;
}

void check_against_ipopt(const QpProblem& problem, const DenseQp& qp) {
  const std::optional<OracleAnswer> answer = mpm::test::solve_with_ipopt(problem);
  if (!answer) return;
  REQUIRE(answer->solved);
  const double own = problem.cost(qp.solution());
  const double theirs = problem.cost(answer->x);
  // Ipopt stops at a scaled error of 1e-10; 1e-6 of the cost is what its own accuracy was measured
  // to be on such problems.
  const double scale =
      1.0 + std::abs(own) + 0.5 * qp.solution().dot(problem.hessian * qp.solution());
  CHECK(std::abs(own - theirs) <= 1e-6 * scale);
}

}  // namespace

TEST_CASE("without active rows the optimum is the unconstrained one") {
  MatrixXd h(2, 2);
  h << 2.0, 0.0, 0.0, 4.0;
  DenseQp qp(h, MatrixXd::Identity(2, 2));
  CHECK(qp.solve(Eigen::Vector2d(-2.0, -4.0), Eigen::Vector2d(-5, -5), Eigen::Vector2d(5, 5)) ==
        QpStatus::kOptimal);
  CHECK(qp.solution()(0) == Approx(1.0));
  CHECK(qp.solution()(1) == Approx(1.0));
  CHECK(qp.iterations() == 0);
  CHECK(qp.multipliers().isZero());
}

TEST_CASE("the example of Goldfarb and Idnani's paper") {
  // min 6 x1 + 2 (x1^2 - x1 x2 + x2^2), x1, x2 >= 0, x1 + x2 >= 2: solution (1/2, 3/2), cost 6.5.
  MatrixXd h(2, 2), a(3, 2);
  h << 4.0, -2.0, -2.0, 4.0;
  a << 1.0, 0.0, 0.0, 1.0, 1.0, 1.0;
  DenseQp qp(h, a);
  REQUIRE(qp.solve(Eigen::Vector2d(6.0, 0.0), Eigen::Vector3d(0.0, 0.0, 2.0),
                   Eigen::Vector3d::Constant(kInfinity)) == QpStatus::kOptimal);
  CHECK(qp.solution()(0) == Approx(0.5));
  CHECK(qp.solution()(1) == Approx(1.5));
  CHECK(qp.multipliers()(2) == Approx(5.0));  // 4 (1/2) - 2 (3/2) + 6
}

TEST_CASE("random problems meet the optimality conditions and Ipopt's cost") {
  Random random(11);
  for (int repeat = 0; repeat < 400; ++repeat) {
    const Index n = 1 + random.below(20);
    const QpProblem problem = feasible_problem(random, n, 1 + random.below(4 * n), 100.0);
    DenseQp qp(problem.hessian, problem.rows);
    CAPTURE(repeat, n, problem.rows.rows());
    REQUIRE(qp.solve(problem.gradient, problem.lower, problem.upper) == QpStatus::kOptimal);
    CHECK(kkt_error(problem, qp) < 1e-12);
    if (repeat % 4 == 0) check_against_ipopt(problem, qp);
  }
}

TEST_CASE("degenerate vertices, repeated rows and equations do not cycle") {
  Random random(12);
  for (int repeat = 0; repeat < 400; ++repeat) {
    const Index n = 2 + random.below(14);
    const QpProblem problem = degenerate_problem(random, n, 50.0);
    DenseQp qp(problem.hessian, problem.rows);
    CAPTURE(repeat, n);
    REQUIRE(qp.solve(problem.gradient, problem.lower, problem.upper) == QpStatus::kOptimal);
    CHECK(kkt_error(problem, qp) < 1e-10);
    CHECK(qp.iterations() <= 12 * n);  // far below the cap of 20 * (n + 3 n)
    if (repeat % 20 == 0) check_against_ipopt(problem, qp);
  }
}

TEST_CASE("ill-conditioned problems keep the optimality conditions") {
  Random random(13);
  for (const double condition : {1e6, 1e9, 1e12}) {
    for (int repeat = 0; repeat < 100; ++repeat) {
      const Index n = 5 + random.below(10);
      const QpProblem problem = repeat % 2 == 0 ? feasible_problem(random, n, 3 * n, condition)
                                                : degenerate_problem(random, n, condition);
      DenseQp qp(problem.hessian, problem.rows);
      CAPTURE(condition, repeat, n);
      REQUIRE(qp.solve(problem.gradient, problem.lower, problem.upper) == QpStatus::kOptimal);
      CHECK(kkt_error(problem, qp) < 1e-9);
      if (condition < 1e7 && repeat % 10 == 0) check_against_ipopt(problem, qp);
    }
  }
}

TEST_CASE("contradictory rows are found") {
  Random random(14);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Index n = 2 + random.below(12);
    QpProblem problem = feasible_problem(random, n, 2 * n, 100.0);
    // A positive combination of rows that are bounded above must not exceed the combination of
    // their bounds (Farkas): the last row demands that it does.
    VectorXd sum = VectorXd::Zero(n);
    double bound = 0.0;
    for (Index i = 0; i + 1 < 2 * n && i < 4; ++i) {
      const double weight = 1.5 + random.uniform();
      if (!std::isfinite(problem.upper(i))) problem.upper(i) = problem.lower(i) + 1.0;
      sum += weight * problem.rows.row(i).transpose();
      bound += weight * problem.upper(i);
    }
    problem.rows.row(2 * n - 1) = sum;
    problem.lower(2 * n - 1) = bound + 0.01 * sum.norm();
    problem.upper(2 * n - 1) = kInfinity;
    DenseQp qp(problem.hessian, problem.rows);
    CAPTURE(repeat, n);
    CHECK(qp.solve(problem.gradient, problem.lower, problem.upper) == QpStatus::kInfeasible);
    if (repeat % 40 == 0) {
      const std::optional<OracleAnswer> answer = mpm::test::solve_with_ipopt(problem);
      if (answer) CHECK_FALSE(answer->solved);
    }
  }
}

TEST_CASE("bounds and data that make no sense are a status, not an exception") {
  const MatrixXd identity = MatrixXd::Identity(2, 2);
  DenseQp qp(identity, identity);
  const Eigen::Vector2d zero(0, 0), one(1, 1);
  CHECK(qp.solve(zero, one, zero) == QpStatus::kInfeasible);
  CHECK(qp.solve(Eigen::Vector2d(std::nan(""), 0), zero, one) == QpStatus::kIterationLimit);
  CHECK(qp.solve(zero, Eigen::Vector2d(std::nan(""), 0), one) == QpStatus::kInfeasible);
  CHECK(qp.solve(zero, one, one) == QpStatus::kOptimal);
  CHECK(qp.solution() == one);
  // A row of zeros can only be satisfied or not.
  DenseQp empty_row(identity, MatrixXd::Zero(1, 2));
  CHECK(empty_row.solve(zero, VectorXd::Constant(1, -1), VectorXd::Constant(1, 1)) ==
        QpStatus::kOptimal);
  CHECK(empty_row.solve(zero, VectorXd::Constant(1, 1), VectorXd::Constant(1, 2)) ==
        QpStatus::kInfeasible);
  // No rows at all.
  DenseQp free(identity, MatrixXd(0, 2));
  CHECK(free.solve(one, VectorXd(0), VectorXd(0)) == QpStatus::kOptimal);
  CHECK(free.solution() == -one);
  CHECK_THROWS_AS(DenseQp(-identity, identity), std::invalid_argument);
  CHECK_THROWS_AS(DenseQp(identity, MatrixXd::Identity(3, 3)), std::invalid_argument);
}

TEST_CASE("solving does not allocate") {
  Random random(15);
  const QpProblem problem = degenerate_problem(random, 12, 100.0);
  DenseQp qp(problem.hessian, problem.rows);
  const std::uint64_t before = mpm::test::allocation_count();
  const QpStatus status = qp.solve(problem.gradient, problem.lower, problem.upper);
  CHECK(mpm::test::allocation_count() == before);
  CHECK(status == QpStatus::kOptimal);
  CHECK(qp.iterations() > 5);
}
