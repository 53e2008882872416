#include "core/regression/givens_qr.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/regression/rotation_kernel.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::givens_qr_test {
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

TEST_CASE("a preview tells the errors of rows to come and their own uncertainty") {
  // Expected: batch fit of the rows before, leverage x' (X'X)^-1 x by a Householder solve.
  const Problem problem(120, 10, 1, 0.98);
  GivensQr qr = problem.factor();
  const Eigen::MatrixXd all = problem.weighted();
  const Eigen::MatrixXd x = all.leftCols(10);
  const Eigen::VectorXd b = x.colPivHouseholderQr().solve(all.col(10));
  RowBatch batch(11, 3);
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 11; ++c)
      batch.row(k)[c] = test::uniform(static_cast<std::uint64_t>(99 + k), c);
  const Eigen::MatrixXd rows =
      Eigen::Map<const Eigen::Matrix<double, 3, 11, Eigen::RowMajor>, 0, Eigen::OuterStride<>>(
          batch.row(0), Eigen::OuterStride<>(batch.row(1) - batch.row(0)));
  std::array<GivensQr::Preview, 3> previews{};
  qr.preview_batch(batch, 3, previews.data());
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd row = rows.row(k);
    const Eigen::VectorXd h = x.transpose().completeOrthogonalDecomposition().solve(row.head(10));
    const GivensQr::Preview& preview = previews[static_cast<std::size_t>(k)];
    CHECK(preview.error == Approx(row(10) - row.head(10).dot(b)).epsilon(1e-10));
    CHECK(preview.leverage == Approx(h.squaredNorm()).epsilon(1e-10));
  }
  const double before = qr.residual_square(0);
  Eigen::Map<Eigen::VectorXd>(qr.row(), 11) = rows.row(0);
  qr.update(1.0);
  CHECK(
      qr.residual_square(0) - before ==
      Approx(previews[0].error * previews[0].error / (1.0 + previews[0].leverage)).epsilon(1e-10));
}

TEST_CASE("rows taken together leave the bits of rows taken one by one") {
  // Few rows at first, so that columns are new and little of the stored rows is kept; 20 columns:
  // two groups and a rest; column 7 says nothing that column 6 does not.
  constexpr int kColumns = 20;
  for (const int together : {2, 7, 33}) {
    GivensQr one_by_one(kColumns, 3), at_once(kColumns, 3);
    RowBatch batch(kColumns + 3, together);
    for (int begin = 0; begin < 200; begin += together) {
      for (int k = 0; k < together; ++k) {
        for (int c = 0; c < kColumns + 3; ++c)
          batch.row(k)[c] = c == 7 ? 2.0 * batch.row(k)[6]
                                   : test::uniform(static_cast<std::uint64_t>(c), begin + k);
        std::copy_n(batch.row(k), kColumns + 3, one_by_one.row());
        one_by_one.update(0.97);
      }
      at_once.update_batch(batch, together, 0.97);
    }
    bool same = true;
    for (int i = 0; i < kColumns; ++i) {
      same = same && one_by_one.root(i) == at_once.root(i);
      for (int j = i; j < kColumns; ++j) same = same && one_by_one.r(i, j) == at_once.r(i, j);
      for (int r = 0; r < 3; ++r) same = same && one_by_one.z(i, r) == at_once.z(i, r);
    }
    for (int r = 0; r < 3; ++r)
      same = same && one_by_one.residual_product(r) == at_once.residual_product(r) &&
             one_by_one.residual_square(r) == at_once.residual_square(r);
    CHECK(same);
  }
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

// All long loops of one instruction set, on the same numbers; everything that they leave.
std::vector<double> run(const KernelSet& kernels) {
  constexpr std::size_t kWidth = 8 + 40;  // a head and whole granules behind it
  constexpr int kRows = 37;
  constexpr std::size_t kAll = kWidth * kRows;
  const AlignedArray stored = make_aligned(8 * kWidth);
  const AlignedArray x = make_aligned(kAll);
  const AlignedArray projected = make_aligned(kAll);
  for (std::size_t i = 0; i < kAll; ++i) x[i] = test::uniform(1, static_cast<std::int64_t>(i));
  std::copy_n(x.get(), kAll, projected.get());
  double* r[8];
  const double* seen[8];
  for (std::size_t a = 0; a < 8; ++a) {
    r[a] = stored.get() + a * kWidth;
    seen[a] = r[a];
    for (std::size_t i = 0; i < kWidth; ++i)
      r[a][i] = i < a ? 0.0 : i == a ? 1.0 : test::uniform(2 + a, static_cast<std::int64_t>(i));
  }
  std::vector<double> weights(8, 3.0), row_weights(kRows, 1.0), magnitudes(8, 2.0);
  weights[5] = 0.0;  // never seen
  std::vector<double> entries(8 * kRows), gains(entries), kept(entries), products(kRows);
  kernels.eliminate_heads(r, {x.get(), kWidth, kRows},
                          {0.99, weights.data(), row_weights.data(), magnitudes.data(), 0,
                           entries.data(), gains.data(), kept.data()});
  for (double*& row : r) row += 8;
  kernels.eliminate_block(r, {x.get() + 8, kWidth, kRows}, kWidth - 8, entries.data(),
                          gains.data());
  kernels.project_heads(seen, {projected.get(), kWidth, kRows}, magnitudes.data(), entries.data());
  for (const double*& row : seen) row += 8;
  kernels.project_block(seen, {projected.get() + 8, kWidth, kRows}, kWidth - 8, entries.data());
  kernels.inner_products(r[0], {projected.get() + 8, kWidth, kRows}, kWidth - 8, products.data());
  kernels.rotate_rows(r[0], x.get() + 8, 39, 0.8, 0.6, 0.8, 0.599);
  kernels.eliminate_row(r[1], x.get() + 8, 39, 0.3, 0.7);
  kernels.blend_row(r[2], x.get() + 8, 39, 0.1, 0.2, 0.9);
  kernels.project_row(r[3], x.get() + 8, 39, 0.4);
  std::vector<double> tops(7, 0.3);
  kernels.reflect(r[4], {x.get() + 9 * kWidth + 8, kWidth, 7}, kWidth - 8, 0.4, tops.data());
  kernels.subtract_past(x.get(), 5 * kWidth - 1, gains.data(), 5, projected.get());
  std::vector<double> all = {stored.get(), stored.get() + 8 * kWidth};
  for (const double* values : {x.get(), projected.get()})
    for (int k = 0; k < kRows; ++k)  // what is left of a head is of no use to anybody
      all.insert(all.end(), values + static_cast<std::size_t>(k) * kWidth + 8,
                 values + static_cast<std::size_t>(k + 1) * kWidth);
  all.insert(all.end(), projected.get(), projected.get() + 5 * kWidth);
  for (const auto* values : {&tops, &weights, &row_weights, &entries, &gains, &kept, &products})
    all.insert(all.end(), values->begin(), values->end());
  return all;
}

TEST_CASE("every instruction set gives the same bits") {
  const std::vector<double> base = run(MPM_KERNELS(kernels_base));
  CHECK(std::all_of(base.begin(), base.end(), [](double value) { return !std::isnan(value); }));
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    CHECK(base == run(MPM_KERNELS(kernels_v3)));
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    CHECK(base == run(MPM_KERNELS(kernels_v4)));
#endif
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
}  // namespace mpm::givens_qr_test
