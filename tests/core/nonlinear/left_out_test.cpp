#include "core/nonlinear/left_out.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm {
namespace {

constexpr int kRows = 200, kFirst = 3, kCount = 5;

struct Data {
  Eigen::MatrixXd x{kRows, kFirst + kCount};
  Eigen::VectorXd y{kRows};
  GivensQr factor{kFirst + kCount, 1};

  explicit Data(bool copied = false) {
    for (int k = 0; k < kRows; ++k) {
      x(k, 0) = 1.0;
      for (int c = 1; c < kFirst + kCount; ++c)
        x(k, c) = test::coloured(static_cast<std::uint64_t>(c), k) + 0.5 * x(k, c - 1);
      if (copied) x(k, 6) = 2.0 * x(k, 4) - x(k, 1);
      y(k) = 0.1 * x.row(k).sum() + test::uniform(50, k);
      for (int c = 0; c < kFirst + kCount; ++c) factor.row()[c] = x(k, c);
      factor.row()[kFirst + kCount] = y(k);
      factor.update(1.0);
    }
  }
  [[nodiscard]] Eigen::VectorXd rotated() const {
    Eigen::VectorXd z(kCount);
    for (int c = 0; c < kCount; ++c) z(c) = factor.z(kFirst + c, 0);
    return z;
  }
  // Residual sum of squares on all columns but these, by another factorisation.
  [[nodiscard]] double without(const std::vector<int>& columns) const {
    Eigen::MatrixXd kept(kRows, kFirst + kCount - static_cast<int>(columns.size()));
    Eigen::Index at = 0;
    for (int c = 0; c < kFirst + kCount; ++c)
      if (std::find(columns.begin(), columns.end(), c - kFirst) == columns.end())
        kept.col(at++) = x.col(c);
    const Eigen::VectorXd fitted = kept * kept.colPivHouseholderQr().solve(y);
    return (y - fitted).squaredNorm();
  }
};

}  // namespace

TEST_CASE("what is lost is the difference of two residual sums of squares") {
  const Data data;
  LeftOut left_out(kFirst, kCount);
  left_out.read(data.factor, data.rotated());
  const double all = data.without({});
  for (const std::vector<int>& columns :
       {std::vector{0}, std::vector{4}, std::vector{1, 3}, std::vector{0, 1, 2, 3, 4}}) {
    const LeftOut::Loss loss = left_out.loss(columns);
    CHECK(loss.square == Approx(data.without(columns) - all).epsilon(1e-9));
    CHECK(loss.columns == static_cast<int>(columns.size()));
  }
  CHECK(left_out.explained() == Approx(data.without({0, 1, 2, 3, 4}) - all).epsilon(1e-9));
}

TEST_CASE("a column that others explain takes no part") {
  const Data data(true);
  LeftOut left_out(kFirst, kCount);
  left_out.read(data.factor, data.rotated());
  CHECK_FALSE(left_out.live(3));
  const LeftOut::Loss loss = left_out.loss({2, 3, 4});
  CHECK(loss.columns == 2);
  CHECK(loss.square == Approx(data.without({2, 3, 4}) - data.without({3})).epsilon(1e-8));
  CHECK(left_out.loss_of({3}, 3, 1.0) == 0.0);
}

TEST_CASE("what would be lost of a given coefficient is its column's own part") {
  const Data data;
  LeftOut left_out(kFirst, kCount);
  left_out.read(data.factor, data.rotated());
  // Of one column alone: coefficient^2 times what all others leave of the column.
  Eigen::MatrixXd others(kRows, kFirst + kCount - 1);
  others << data.x.leftCols(kFirst + 2), data.x.rightCols(2);
  const Eigen::VectorXd column = data.x.col(kFirst + 2);
  const double own = (column - others * others.colPivHouseholderQr().solve(column)).squaredNorm();
  const std::vector<int> alone = {2};
  const std::uint64_t before = test::allocation_count();
  const double lost = left_out.loss_of(alone, 2, 0.3);
  CHECK(test::allocation_count() == before);
  CHECK(lost == Approx(0.09 * own).epsilon(1e-9));
  CHECK_THROWS_AS(LeftOut(0, 3), std::invalid_argument);
}

}  // namespace mpm
