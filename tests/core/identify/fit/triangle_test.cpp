#include "core/identify/fit/triangle.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::triangle_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random(Index rows, Index columns) {
  MatrixXd matrix(rows, columns);
  for (Index c = 0; c < columns; ++c)
    matrix.col(c) = test::white(static_cast<std::uint64_t>(c + 1), rows);
  return matrix;
}

// A triangle is known but for the signs of its rows.
MatrixXd with_positive_diagonal(MatrixXd r) {
  for (Index i = 0; i < r.rows(); ++i)
    if (r(i, i) < 0.0) r.row(i) = -r.row(i);
  return r;
}

// Expected: Eigen's Householder QR of all rows at once. Rows below, at and beyond whole blocks.
TEST_CASE("rows taken in blocks have the triangle of all of them at once") {
  for (const Index columns : {1, 2, 6, 23})
    for (const Index rows : {columns, Index{40}, Index{256}, Index{257}, Index{1000}}) {
      CAPTURE(rows, columns);
      const MatrixXd matrix = random(rows, columns);
      const MatrixXd all = Eigen::HouseholderQR<MatrixXd>(matrix).matrixQR().topRows(columns);
      const MatrixXd expected =
          with_positive_diagonal(all.triangularView<Eigen::Upper>().toDenseMatrix());
      const MatrixXd r = with_positive_diagonal(triangle(matrix));
      CHECK((r - expected).norm() <= 1e-13 * expected.norm());
    }
}

// R'R = A'A of any matrix, however its zeros lie (Golub and Van Loan 2013, 5.2).
TEST_CASE("a triangle is that of its rows, zeros or not") {
  constexpr Index kColumns = 9, kLong = 1000;
  MatrixXd matrix = random(kLong, kColumns);
  matrix.col(0).tail(kLong - 300).setZero();
  matrix.col(1).head(300).setZero();
  matrix.col(4).setZero();
  matrix.col(6) = 1e8 * matrix.col(2);
  const MatrixXd r = triangle(matrix);
  REQUIRE(r.rows() == kColumns);
  CHECK(r.isUpperTriangular(0.0));
  const VectorXd scale = matrix.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const MatrixXd as_given = scale.asDiagonal() * (matrix.transpose() * matrix) * scale.asDiagonal();
  const MatrixXd as_made = scale.asDiagonal() * (r.transpose() * r) * scale.asDiagonal();
  CHECK((as_made - as_given).cwiseAbs().maxCoeff() < 1e-13);
  CHECK(triangle(matrix.topRows(4)).rows() == 4);

  matrix(500, 3) = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(triangle(matrix)(3, 3)));
}

TEST_CASE("fewer rows than columns give as many rows") {
  const MatrixXd matrix = random(3, 5);
  const MatrixXd r = triangle(matrix);
  REQUIRE(r.rows() == 3);
  CHECK((r.transpose() * r - matrix.transpose() * matrix).norm() <= 1e-13 * matrix.squaredNorm());
}

}  // namespace
}  // namespace mpm::triangle_test
