#include "core/identify/evidence/change_row.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

/// Two inputs, one CV under integrating noise; the first channel's gain is `ratio` times the
/// model's from row `from` on.
std::optional<Index> changed_row(double ratio, std::uint64_t seed, Index from) {
  constexpr Index kRows = 1500;
  MatrixXd u(kRows, 2);
  u << test::telegraph(seed, kRows, 12), test::telegraph(seed + 1000, kRows, 9);
  const VectorXd first = test::first_order(u.col(0), 2.0, 10.0);
  const VectorXd model = first + test::first_order(u.col(1), 1.0, 5.0);
  VectorXd residuals = 0.1 * test::white(seed + 2000, kRows);
  for (Index k = 1; k < kRows; ++k) residuals(k) += residuals(k - 1);
  residuals.tail(kRows - from) += (ratio - 1.0) * first.tail(kRows - from);
  const ModelSpec spec = test::model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, 1.0, 5.0)}, 2, 1);
  const Recording recording = test::recording_of(u, model + residuals);
  return change_row(spec, recording, residuals, ChannelTests(spec, recording, residuals));
}

TEST_CASE("a change of a channel is dated, and what was always so is none") {
  // Looked for at each hundredth of the rows; 20 of 20 within three of them. Where nothing or all
  // is wrong a walk may look like one, which only parts the rows otherwise.
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const std::optional<Index> changed = changed_row(1.5, seed, 800);
    REQUIRE(changed.has_value());
    CHECK(std::abs(*changed - 800) <= 45);
    none += changed_row(1.0, seed, 0).has_value() ? 0 : 1;
    none += changed_row(1.5, seed, 0).has_value() ? 0 : 1;
  }
  CHECK(none >= 36);
}

}  // namespace
}  // namespace mpm
