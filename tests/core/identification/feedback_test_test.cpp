#include "core/identification/feedback_test.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("feedback is seen where there is some, also one without dynamics") {
  // p-values: uniform without feedback, below 1e-3 once in a thousand.
  CHECK(feedback_p_value(identification_data(Loop().run(1500)), 0) < 1e-9);
  CHECK(feedback_p_value(identification_data(open_loop(1500, 910)), 0) > 1e-3);
  CHECK(feedback_p_value(identification_data(open_loop(1500, 910)), 1) > 1e-3);
  Loop still;
  still.setpoint_moves = false;
  CHECK(feedback_p_value(identification_data(still.run(1500)), 0) < 1e-9);
}

// An engineer's steps, up and down in turn: the longer ago the last one was the likelier is the
// next, and of six lags and the CV only the CV knows how long ago that is. Of 60 such tests 2 come
// below 1e-3, without the means all.
TEST_CASE("steps by hand are not moved by the CV that answers them") {
  int fed_back = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    MatrixXd inputs(4000, 1), cvs(4000, 1);
    double level = 1.0;
    Index until = 0;
    for (Index k = 0; k < 4000; ++k) {
      if (k == until) {
        level = (level > 0.0 ? -1.0 : 1.0) * (1.0 + 0.35 * uniform(960 + seed, k));
        until = k + 80 + static_cast<Index>(45.0 * uniform(980 + seed, k));
      }
      inputs(k, 0) = level;
    }
    cvs.col(0) =
        first_order(inputs.col(0), 2.0, 80.0) + 0.1 * autoregressive(white(990 + seed, 4000), 0.9);
    fed_back += feedback_p_value(identification_data(recording_of(inputs, cvs)), 1) < 1e-3 ? 1 : 0;
  }
  CHECK(fed_back <= 2);
}

TEST_CASE("a test signal is told from what a controller moves") {
  const std::vector<bool> loop = test_signals(identification_data(Loop().run(1500)));
  CHECK_FALSE(loop[0]);
  CHECK(loop[1]);  // a telegraph
  Loop still;
  still.setpoint_moves = false;
  CHECK_FALSE(test_signals(identification_data(still.run(1500)))[0]);
  // A thermostat: two levels, switched by the CV with a hysteresis.
  MatrixXd inputs(1500, 1), cvs(1500, 1);
  const VectorXd wandering = autoregressive(0.3 * white(912, 1500), 0.95);
  double heat = 1.0, room = 0.0;
  for (Index k = 0; k < 1500; ++k) {
    cvs(k, 0) = room + wandering(k);
    if (cvs(k, 0) > 0.5) heat = -1.0;
    if (cvs(k, 0) < -0.5) heat = 1.0;
    inputs(k, 0) = heat;
    room += 0.1 * (2.0 * heat - room);
  }
  CHECK_FALSE(test_signals(identification_data(recording_of(inputs, cvs)))[0]);
  inputs.col(0) = white(911, 1500);
  cvs.col(0) = first_order(inputs.col(0), 1.0, 5.0, 1);
  CHECK(test_signals(identification_data(recording_of(inputs, cvs)))[0]);
}

}  // namespace mpm::test
