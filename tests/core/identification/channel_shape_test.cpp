#include "core/identification/channel_shape.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("a first-order channel answers as its difference equation does") {
  const VectorXd u = telegraph(902, 200, 13);
  ChannelShape shape;
  shape.gain = -2.5;
  shape.time_constant = 7.0;
  shape.dead_time = 3.0;
  const VectorXd y = response(shape, u, {{0, 200}});
  const VectorXd expected = first_order(u, -2.5, 7.0, 3);
  CHECK((y - expected).cwiseAbs().maxCoeff() < 1e-12);
}

}  // namespace mpm::test
