#include "core/identification/identify_long.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Gain 2 and noise of 0.3 whose time constant is a tenth of the plant's.
Recording one_channel(Index rows, double time_constant, Index dead, Index hold) {
  const VectorXd u = telegraph(41, rows, hold);
  const double pole = std::exp(-10.0 / time_constant);
  const VectorXd noise =
      0.3 * std::sqrt(1.0 - pole * pole) * autoregressive(normal(42, rows), pole);
  return recording_of(u, first_order(u, 2.0, time_constant, dead) + noise);
}

bool overlap(const Interval95& a, const Interval95& b) { return a.low < b.high && b.low < a.high; }

}  // namespace

TEST_CASE("a long recording of a slow plant gives averaged what it gives whole") {
  const Recording recording = one_channel(30'000, 400.0, 50, 300);
  const LongIdentification shorter = identify_long(recording, {});
  CHECK(shorter.data.how.given == 30'000);
  CHECK(shorter.data.how.every == 2);
  CHECK(shorter.data.how.stretches == 0);
  const ChannelAnswer& answer = answer_of(shorter.identification, 0, 0);
  const Identification whole = identify(recording, {});
  const ChannelAnswer& expected = answer_of(whole, 0, 0);
  REQUIRE(answer.left_out == LeftOut::kIdentified);
  REQUIRE(answer.time_constants.size() == 1);
  REQUIRE(expected.time_constants.size() == 1);
  CHECK(overlap(answer.gain, expected.gain));
  CHECK(overlap(answer.time_constants[0], expected.time_constants[0]));
  CHECK(answer.dynamics->dead_time_s == Approx(expected.dynamics->dead_time_s).margin(2.0));
  CHECK(answer.dynamics->gain == Approx(2.0).epsilon(0.05));
  CHECK(answer.dynamics->time_constants_s[0] == Approx(400.0).epsilon(0.1));
  CHECK(shorter.identification.model.sample_time_s == 2.0);
  CHECK(model_at(shorter.identification, 1.0).sample_time_s == 1.0);
}

TEST_CASE("of a fast plant stretches are taken, at its own sample time") {
  const LongIdentification shorter = identify_long(one_channel(60'000, 20.0, 5, 40), {});
  CHECK(shorter.data.how.every == 1);
  CHECK(shorter.data.how.stretches == 8);
  const ChannelAnswer& answer = answer_of(shorter.identification, 0, 0);
  REQUIRE(answer.left_out == LeftOut::kIdentified);
  CHECK(answer.dynamics->gain == Approx(2.0).epsilon(0.02));
  CHECK(answer.dynamics->dead_time_s == Approx(5.0).margin(0.5));
}

}  // namespace mpm::test
