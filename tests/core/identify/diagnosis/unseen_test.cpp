#include "core/identify/diagnosis/unseen.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::VectorXd;
using test::lag;

// By hand: two time constants of the slowest channel, 20 s at 2 s a row, and ten rows.
TEST_CASE("unseen samples are the last of a recording, in blocks that outlast the plant's memory") {
  const VectorXd u = test::telegraph(1, 300, 12), y = test::first_order(u, 2.0, 10.0);
  Recording recording = test::recording_of(u, y);
  recording.sample_time_s = 2.0;
  ModelSpec model = test::model_of({lag(0, 0, 2.0, 20.0), lag(0, 0, 0.0, 6.0)}, 1, 1);
  model.sample_time_s = 2.0;
  Unseen unseen(recording, 80, model, 7);
  CHECK(unseen.rows() == 80);
  CHECK(unseen.block() == 30);
  CHECK(unseen.seed() == 7);
  CHECK(unseen.measured(0) == y.tail(80));
  // The whole past is simulated, so that no first state is left in them.
  CHECK(unseen.simulated(model, 0).isApprox(y.tail(80), 1e-9));
  CHECK(unseen.free_runs(model).rows() == 300);
}

// Of noise with a known memory the one-step errors are what drives it; a level is none of it.
TEST_CASE("innovations are the errors that the residual's own past does not tell") {
  constexpr Eigen::Index kRows = 4000, kUnseen = 1000, kGap = 3500;
  const VectorXd u = test::telegraph(1, kRows, 12), driving = 0.3 * test::normal(5, kRows);
  const VectorXd noise = test::autoregressive(driving, 0.9).array() + 7.0;
  Recording recording = test::recording_of(u, noise);
  recording.cvs(kGap, 0) = std::numeric_limits<double>::quiet_NaN();
  Unseen unseen(recording, kUnseen, test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1), 1);
  const VectorXd squares = unseen.innovations(recording.cvs.col(0));
  REQUIRE(squares.size() == kUnseen);
  // The row and those of which the past is not known.
  CHECK(squares.array().isNaN().count() == 25);
  const VectorXd known = squares.head(kGap - (kRows - kUnseen));
  const VectorXd driven = driving.segment(kRows - kUnseen, known.size()).cwiseAbs2();
  CHECK(known.mean() == Approx(driven.mean()).epsilon(0.03));
}

}  // namespace
}  // namespace mpm
