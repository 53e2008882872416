#include "core/mismatch/input_errors.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "tests/core/counter_noise.hpp"

namespace mpm {

TEST_CASE("one channel's errors are what is left of them beside all others") {
  // Expected: Eigen's least squares of the same rows, the channel's columns last.
  constexpr int kRows = 40, kColumns = 3 * kUsualErrors, kOwn = kUsualErrors;
  Eigen::MatrixXd rows(kRows, kColumns + 3);
  GivensQr all(kColumns, 3);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < rows.cols(); ++c)
      rows(r, c) = test::uniform(static_cast<std::uint64_t>(c), r);
    for (int c = 0; c < rows.cols(); ++c) all.row()[c] = rows(r, c);
    all.update(1.0);
  }
  InputErrors errors(kColumns);
  const InputErrors::Channel& channel = errors.read(all, kOwn, 1);
  Eigen::MatrixXd others(kRows, kColumns - kUsualErrors);
  others << rows.leftCols(kOwn), rows.middleCols(kOwn + kUsualErrors, kUsualErrors);
  const auto beside = [&](const Eigen::MatrixXd& of) {
    return Eigen::MatrixXd(of - others * others.householderQr().solve(of));
  };
  const Eigen::MatrixXd own = beside(rows.middleCols(kOwn, kUsualErrors));
  const Eigen::MatrixXd fitted = own.householderQr().solve(beside(rows.rightCols(3)));
  CHECK((channel.usual.transpose() * channel.usual - own.transpose() * own).norm() < 1e-9);
  const Eigen::VectorXd sizes =
      channel.usual.triangularView<Eigen::Upper>().solve(channel.estimate);
  CHECK((sizes - fitted.col(0)).norm() < 1e-9);
  for (const int shift : {error_column::kLater, error_column::kEarlier}) {
    const Eigen::VectorXd by =
        channel.usual.triangularView<Eigen::Upper>().solve(channel.directions.col(shift));
    CHECK((by - fitted.col(shift == error_column::kLater ? 1 : 2)).norm() < 1e-9);
  }
  CHECK(channel.directions.col(error_column::kGain) == channel.usual.col(0));
  CHECK(channel.directions.col(error_column::kTime) == channel.usual.col(1));
}

}  // namespace mpm
