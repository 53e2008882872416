#include "core/identification/prediction_error.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("identify is right in closed loop, as an independent fit of the same data is") {
  // Expected numbers: tests/oracles/identification.py, scipy's least squares.
  const Identification found = identify(Loop().run(1500), {});
  const auto expected = read_oracle("identification.json");
  int input = 0;
  for (const char* name : {"first", "second"}) {
    CAPTURE(name);
    const ChannelAnswer& answer = answer_of(found, 0, input++);
    REQUIRE(answer.left_out == LeftOut::kIdentified);
    const auto close = [&](const char* number, double value) {
      const double sd = expected[name][number]["sd"];
      CAPTURE(number);
      CHECK(value == Approx(double(expected[name][number]["value"])).margin(0.5 * sd));
    };
    close("gain", answer.dynamics->gain);
    close("time_constant", answer.dynamics->time_constants_s.at(0));
    close("dead_time", answer.dynamics->dead_time_s);
    const double width = (answer.gain.high - answer.gain.low) / 2.0 / 1.96;
    CHECK(width == Approx(double(expected[name]["gain"]["sd"])).epsilon(0.2));
  }
  CHECK(found.cvs[0].innovation_sd * found.cvs[0].innovation_sd ==
        Approx(double(expected["variance"])).epsilon(0.05));
  CHECK(found.feedback_p_value < 1e-3);
}

}  // namespace mpm::test
