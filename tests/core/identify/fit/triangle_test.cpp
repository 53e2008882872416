#include "core/identify/fit/triangle.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::triangle_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

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

TEST_CASE("columns that are zero in most rows, or in all, keep their place") {
  MatrixXd matrix = random(600, 4);
  matrix.col(0).tail(500).setZero();
  matrix.col(2).setZero();
  const MatrixXd r = triangle(matrix);
  CHECK(r.col(2).isZero());
  CHECK((r.transpose() * r - matrix.transpose() * matrix).norm() <= 1e-11);
  CHECK(r.triangularView<Eigen::StrictlyLower>().toDenseMatrix().isZero());
}

TEST_CASE("fewer rows than columns give as many rows") {
  const MatrixXd matrix = random(3, 5);
  const MatrixXd r = triangle(matrix);
  REQUIRE(r.rows() == 3);
  CHECK((r.transpose() * r - matrix.transpose() * matrix).norm() <= 1e-13 * matrix.squaredNorm());
}

TEST_CASE("what is no number stays none") {
  MatrixXd matrix = random(300, 3);
  matrix(280, 1) = std::nan("");
  CHECK_FALSE(triangle(matrix).col(2).allFinite());
}

}  // namespace
}  // namespace mpm::triangle_test
