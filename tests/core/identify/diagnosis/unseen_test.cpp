#include "core/identify/diagnosis/unseen.hpp"

#include <catch2/catch.hpp>

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

}  // namespace
}  // namespace mpm
