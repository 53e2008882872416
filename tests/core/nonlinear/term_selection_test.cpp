#include "core/nonlinear/term_selection.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::term_selection_test {
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
  // What the first columns and these leave of a signal, by another factorisation.
  [[nodiscard]] double left(const Eigen::VectorXd& signal, const std::vector<int>& columns) const {
    Eigen::MatrixXd kept(kRows, kFirst + static_cast<int>(columns.size()));
    kept.leftCols(kFirst) = x.leftCols(kFirst);
    for (std::size_t c = 0; c < columns.size(); ++c)
      kept.col(kFirst + static_cast<Eigen::Index>(c)) = x.col(kFirst + columns[c]);
    return (signal - kept * kept.colPivHouseholderQr().solve(signal)).squaredNorm();
  }
};

}  // namespace

TEST_CASE("what a group explains is the difference of two residual sums of squares") {
  const Data data;
  TermSelection selection(kFirst, kCount);
  selection.read(data.factor, data.rotated());
  CHECK(selection.all().columns == kCount);
  CHECK(selection.all().square ==
        Approx(data.left(data.y, {}) - data.left(data.y, {0, 1, 2, 3, 4})).epsilon(1e-9));
  for (const std::vector<int>& columns : {std::vector{0}, std::vector{4}, std::vector{1, 3}}) {
    const TermSelection::Gain gain = selection.gain(columns);
    CHECK(gain.square == Approx(data.left(data.y, {}) - data.left(data.y, columns)).epsilon(1e-9));
    CHECK(gain.columns == static_cast<int>(columns.size()));
  }
}

TEST_CASE("what is taken in is no longer there for others") {
  const Data data;
  TermSelection selection(kFirst, kCount);
  selection.read(data.factor, data.rotated());
  const std::vector<int> first = {1, 3}, second = {2}, again = {1, 2};
  const std::uint64_t before = test::allocation_count();
  const TermSelection::Gain taken = selection.take(first);
  const TermSelection::Gain more = selection.gain(second);
  const TermSelection::Gain same = selection.gain(again);
  CHECK(test::allocation_count() == before);
  CHECK(taken.square == Approx(data.left(data.y, {}) - data.left(data.y, {1, 3})).epsilon(1e-9));
  CHECK(more.square ==
        Approx(data.left(data.y, {1, 3}) - data.left(data.y, {1, 2, 3})).epsilon(1e-9));
  CHECK(same.columns == 1);
  CHECK(same.square == Approx(more.square).epsilon(1e-9));
  CHECK(selection.norm_left(4) ==
        Approx(std::sqrt(data.left(data.x.col(kFirst + 4), {1, 3}))).epsilon(1e-9));
  CHECK(selection.norm_left(3) == 0.0);
}

TEST_CASE("a column that others explain takes no part") {
  const Data data(true);
  TermSelection selection(kFirst, kCount);
  selection.read(data.factor, data.rotated());
  CHECK(selection.all().columns == kCount - 1);
  const TermSelection::Gain gain = selection.gain({1, 2, 3});
  CHECK(gain.columns == 2);
  CHECK(gain.square == Approx(data.left(data.y, {}) - data.left(data.y, {1, 2})).epsilon(1e-8));
  CHECK_THROWS_AS(TermSelection(0, 3), std::invalid_argument);
}

}  // namespace mpm::term_selection_test
