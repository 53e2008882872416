#include "core/identification/damped_pair.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;

TEST_CASE("a damped pair overshoots as textbooks say, and its sampled form does the same") {
  // Peak of a step response: 1 + e^{-pi z / sqrt(1 - z^2)} at pi T / sqrt(1 - z^2).
  const DampedPair pair{6.0, 0.35};
  const double root = std::sqrt(1.0 - 0.35 * 0.35), pi = std::acos(-1.0);
  CHECK(step_response(pair, pi * 6.0 / root) ==
        Approx(1.0 + std::exp(-pi * 0.35 / root)).epsilon(1e-12));
  CHECK(step_response(pair, -1.0) == 0.0);
  for (const double dead_time : {0.0, 4.0, 4.6}) {
    CAPTURE(dead_time);
    const DiscreteFilter filter = sampled(pair, 2.5, dead_time, 2.0);
    std::vector<double> y(40, 0.0);
    for (std::size_t k = 1; k < y.size(); ++k) {
      for (std::size_t n = 0; n < filter.numerator.size(); ++n)
        if (k >= 1 + n + static_cast<std::size_t>(filter.delay_samples))
          y[k] += filter.numerator[n];
      for (std::size_t n = 1; n < filter.denominator.size() && n <= k; ++n)
        y[k] -= filter.denominator[n] * y[k - n];
      const double since = 2.0 * static_cast<double>(k) - dead_time;
      CHECK(y[k] == Approx(2.5 * step_response(pair, since)).margin(1e-12));
    }
  }
}

TEST_CASE("a channel that overshoots gets its damped pair, one that does not none") {
  // Expected numbers: tests/oracles/identification_damped.py, scipy's least squares.
  const Index rows = 3000;
  MatrixXd inputs(rows, 2), cvs(rows, 1);
  inputs << telegraph(841, rows, 35), telegraph(842, rows, 50);
  cvs = first_order(inputs.col(1), 0.7, 12.0, 4) + autoregressive(0.05 * white(843, rows), 0.9);
  const DampedPair pair{6.0, 0.35};
  for (Index j = 1; j < rows; ++j) {
    const double move = inputs(j, 0) - inputs(j - 1, 0);
    if (move == 0.0) continue;
    for (Index k = j; k < rows; ++k)
      cvs(k, 0) += 2.0 * move * step_response(pair, static_cast<double>(k - j) - 2.0);
  }
  const Identification found = identify(recording_of(inputs, cvs), {});
  const ChannelAnswer& damped = answer_of(found, 0, 0);
  REQUIRE(damped.left_out == LeftOut::kIdentified);
  REQUIRE(damped.form == ChannelForm::kDamped);
  const auto expected = read_oracle("identification_damped.json");
  const auto close = [&](const char* number, double value) {
    CAPTURE(number);
    CHECK(value ==
          Approx(double(expected[number]["value"])).margin(double(expected[number]["sd"])));
  };
  close("gain", damped.dynamics->gain);
  close("dead_time", damped.dynamics->dead_time_s);
  close("time", damped.pair->time);
  close("damping", damped.pair->damping);
  CHECK(damped.damping->low < 0.35);
  CHECK(damped.damping->high > 0.35);
  CHECK(std::holds_alternative<DiscreteFilter>(found.model.channels[0].dynamics));
  CHECK(answer_of(found, 0, 1).form == ChannelForm::kFirstOrder);
}

}  // namespace mpm::test
