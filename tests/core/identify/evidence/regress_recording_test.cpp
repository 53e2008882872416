#include "core/identify/evidence/regress_recording.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

std::unique_ptr<MismatchDetector> regressed(Index rows, std::vector<Border> borders = {},
                                            Index remembered = 0) {
  const MatrixXd u = test::telegraph(1, rows, 12);
  const MatrixXd residuals = 0.1 * test::white(2, rows);
  Recording recording = test::recording_of(u, residuals);
  recording.borders = std::move(borders);
  const ModelSpec spec = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  return regress_recording(spec, recording, residuals, remembered).detector;
}

TEST_CASE("the fewer rows, the fewer lags, and of too few there is no regression") {
  const std::unique_ptr<MismatchDetector> many = regressed(2000), few = regressed(80);
  REQUIRE(many);
  REQUIRE(few);
  CHECK(few->shape().columns() < many->shape().columns());
  // Six rows or more stand behind each column (kTestRowsPerColumn).
  CHECK(6 * few->shape().columns() <= 80);
  CHECK_FALSE(regressed(20));
}

TEST_CASE("no row reaches across a border") {
  const std::unique_ptr<MismatchDetector> one = regressed(2000),
                                          two = regressed(2000, {{1000, 0.0}});
  one->fold(0);
  two->fold(0);
  // The first rows of a run lack a past of their own.
  CHECK(one->memory(0).rows - two->memory(0).rows == one->shape().residual_order);
}

TEST_CASE("as many rows can be read again as were asked for") {
  CHECK(regressed(2000, {}, 1500)->history().depth() == 1500);
}

}  // namespace
}  // namespace mpm
