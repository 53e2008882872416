#include "core/regression/givens_qr.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/regression/rotation_kernel.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

// Rows [1, coloured ..., responses] and their factor.
struct Problem {
  Eigen::MatrixXd rows;
  double lambda;
  int columns;
  int responses;

  Problem(int count, int columns_in, int responses_in, double lambda_in)
      : rows(count, columns_in + responses_in),
        lambda(lambda_in),
        columns(columns_in),
        responses(responses_in) {
    for (int k = 0; k < count; ++k)
      for (int c = 0; c < rows.cols(); ++c)
        rows(k, c) = c == 0 ? 1.0 : test::coloured(static_cast<std::uint64_t>(c), k);
  }
  [[nodiscard]] GivensQr factor() const {
    GivensQr qr(columns, responses);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      Eigen::Map<Eigen::RowVectorXd>(qr.row(), rows.cols()) = rows.row(k);
      qr.update(lambda);
    }
    return qr;
  }
  [[nodiscard]] Eigen::MatrixXd weighted() const {
    Eigen::MatrixXd result = rows;
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
      result.row(k) *= std::pow(lambda, 0.5 * static_cast<double>(rows.rows() - 1 - k));
    return result;
  }
};

TEST_CASE("the Givens factor equals a batch Householder factorisation") {
  // Expected: Eigen's column-pivoting Householder QR of all weighted rows at once.
  for (const int columns : {1, 2, 7, 8, 9, 16, 21, 88}) {
    for (const double lambda : {1.0, 0.99}) {
      const Problem problem(400, columns, 3, lambda);
      const GivensQr qr = problem.factor();
      const Eigen::MatrixXd all = problem.weighted();
      const Eigen::MatrixXd x = all.leftCols(columns);
      const Eigen::MatrixXd y = all.rightCols(3);
      const Eigen::MatrixXd b = x.colPivHouseholderQr().solve(y);
      const Eigen::MatrixXd left = y - x * b;
      CAPTURE(columns, lambda);
      for (int r = 0; r < 3; ++r) {
        Eigen::VectorXd coefficients(columns);
        qr.solve(r, columns, coefficients);
        CHECK((coefficients - b.col(r)).norm() <= 1e-11 * (1.0 + b.col(r).norm()));
        CHECK(qr.residual_square(r) == Approx(left.col(r).squaredNorm()).epsilon(1e-12));
        CHECK(qr.residual_product(r) ==
              Approx(left.col(0).dot(left.col(r))).epsilon(1e-10).margin(1e-10));
      }
      // R'R = X'X, entry by entry.
      for (int i = 0; i < columns; ++i)
        for (int j = i; j < columns; ++j) {
          double product = 0.0;
          for (int r = 0; r <= i; ++r) product += qr.r(r, i) * qr.r(r, j);
          CHECK(product == Approx(x.col(i).dot(x.col(j))).epsilon(1e-11).margin(1e-9));
        }
    }
  }
}

TEST_CASE("preview tells the error of the coming row and its own uncertainty") {
  // Expected: batch fit of the rows before, leverage x' (X'X)^-1 x by a Householder solve.
  const Problem problem(120, 10, 1, 0.98);
  GivensQr qr = problem.factor();
  const Eigen::MatrixXd all = problem.weighted() * std::sqrt(0.98);
  const Eigen::MatrixXd x = all.leftCols(10);
  const Eigen::VectorXd b = x.colPivHouseholderQr().solve(all.col(10));
  Eigen::VectorXd row(11);
  for (int c = 0; c < 11; ++c) row(c) = test::uniform(99, c);
  Eigen::Map<Eigen::VectorXd>(qr.row(), 11) = row;
  const Eigen::VectorXd h = x.transpose().completeOrthogonalDecomposition().solve(row.head(10));
  const GivensQr::Preview preview = qr.preview(0.98);
  CHECK(preview.error == Approx(row(10) - row.head(10).dot(b)).epsilon(1e-10));
  CHECK(preview.share == Approx(1.0 / (1.0 + h.squaredNorm())).epsilon(1e-10));
  const double before = qr.residual_square(0);
  qr.update(0.98);
  CHECK(qr.residual_square(0) - 0.98 * before ==
        Approx(preview.share * preview.error * preview.error).epsilon(1e-10));
}

TEST_CASE("scaling the factor is scaling the rows") {
  Problem problem(60, 9, 2, 0.99);
  GivensQr scaled = problem.factor();
  scaled.scale(250.0);
  problem.rows *= 250.0;
  const GivensQr expected = problem.factor();
  for (int i = 0; i < 9; ++i) CHECK(scaled.r(i, 8) == Approx(expected.r(i, 8)).margin(1e-9));
  CHECK(scaled.residual_square(1) == Approx(expected.residual_square(1)).epsilon(1e-11));
}

TEST_CASE("columns that others explain take no part and harm nothing") {
  // Column 3 is constant, column 5 a copy of column 2: both get a diagonal of exactly 0, and the
  // residual is that of the remaining columns (batch Householder).
  Problem problem(200, 7, 1, 0.995);
  problem.rows.col(3).setConstant(-4.7);
  problem.rows.col(5) = problem.rows.col(2);
  const GivensQr qr = problem.factor();
  CHECK(qr.r(3, 3) == 0.0);
  CHECK(qr.r(5, 5) == 0.0);
  const Eigen::MatrixXd all = problem.weighted();
  Eigen::MatrixXd x(200, 5);
  x << all.col(0), all.col(1), all.col(2), all.col(4), all.col(6);
  const Eigen::VectorXd left = all.col(7) - x * x.colPivHouseholderQr().solve(all.col(7)).eval();
  CHECK(qr.residual_square(0) == Approx(left.squaredNorm()).epsilon(1e-12));
  Eigen::VectorXd coefficients(7);
  qr.solve(0, 7, coefficients);
  CHECK(coefficients(3) == 0.0);
  CHECK(coefficients(5) == 0.0);
}

TEST_CASE("information that appears late replaces what rounding left") {
  // Column 2 equals column 1 to within 1e-13 for 300 rows, then moves by itself. The stored row of
  // rounding noise must not spoil what follows: batch Householder, relative 1e-9.
  Problem problem(600, 4, 1, 1.0);
  for (int k = 0; k < 300; ++k)
    problem.rows(k, 2) = problem.rows(k, 1) * (1.0 + 1e-13 * test::uniform(77, k));
  const GivensQr qr = problem.factor();
  const Eigen::MatrixXd x = problem.rows.leftCols(4);
  const Eigen::VectorXd b = x.colPivHouseholderQr().solve(problem.rows.col(4));
  Eigen::VectorXd coefficients(4);
  qr.solve(0, 4, coefficients);
  CHECK((coefficients - b).norm() <= 1e-9 * b.norm());
}

TEST_CASE("every instruction set gives the same bits") {
  constexpr std::size_t kCount = 173;
  const auto run = [](auto rotate, auto eliminate, auto eliminate_eight, auto blend, auto project,
                      auto project_eight) {
    std::vector<double> x(kCount), rows(8 * kCount);
    for (std::size_t i = 0; i < kCount; ++i) x[i] = test::uniform(1, static_cast<std::int64_t>(i));
    for (std::size_t i = 0; i < 8 * kCount; ++i)
      rows[i] = test::uniform(2, static_cast<std::int64_t>(i));
    double* r[8];
    double entries[8], gains[8];
    for (std::size_t a = 0; a < 8; ++a) {
      r[a] = rows.data() + a * kCount;
      entries[a] = test::uniform(3, static_cast<std::int64_t>(a));
      gains[a] = test::uniform(4, static_cast<std::int64_t>(a));
    }
    rotate(r[0], x.data(), kCount, 0.8, 0.6, 0.8, 0.599);
    eliminate(r[1], x.data(), kCount, 0.3, 0.7);
    eliminate_eight(r, x.data(), kCount, entries, gains);
    blend(r[2], x.data(), kCount, 0.1, 0.2, 0.9);
    project(r[3], x.data(), kCount, 0.4);
    project_eight(r, x.data(), kCount, entries);
    rows.insert(rows.end(), x.begin(), x.end());
    return rows;
  };
  const std::vector<double> base =
      run(kernels_base::rotate_rows, kernels_base::eliminate_row, kernels_base::eliminate_rows,
          kernels_base::blend_row, kernels_base::project_row, kernels_base::project_rows);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
    CHECK(base == run(kernels_v3::rotate_rows, kernels_v3::eliminate_row,
                      kernels_v3::eliminate_rows, kernels_v3::blend_row, kernels_v3::project_row,
                      kernels_v3::project_rows));
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    CHECK(base == run(kernels_v4::rotate_rows, kernels_v4::eliminate_row,
                      kernels_v4::eliminate_rows, kernels_v4::blend_row, kernels_v4::project_row,
                      kernels_v4::project_rows));
#endif
  CHECK(base.size() == 9 * kCount);
}

TEST_CASE("a rotation has no range of numbers where it fails") {
  for (const double scale : {1e-300, 1e-160, 1.0, 1e160, 1e300}) {
    const Rotation rotation = make_rotation(3.0 * scale, -4.0 * scale);
    CHECK(rotation.cosine == Approx(0.6));
    CHECK(rotation.sine == Approx(-0.8));
    CHECK(rotation.radius == Approx(5.0 * scale));
  }
  CHECK(make_rotation(-2.0, 0.0).radius == 2.0);
  CHECK(make_rotation(0.0, 0.0).cosine == 1.0);
}

}  // namespace
}  // namespace mpm
