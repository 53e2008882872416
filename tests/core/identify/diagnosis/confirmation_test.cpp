#include "core/identify/diagnosis/confirmation.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/fit/quantity.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::confirmation_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 1500;

ModelSpec one_lag() { return test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1); }

/// `share`: the input's part of what a model gets wrong, as a share of the channel.
ChannelTests tests(double share, double noise = 0.1) {
  const VectorXd u = test::telegraph(1, kRows, 12);
  const VectorXd residual =
      share * test::first_order(u, 2.0, 10.0) + noise * test::normal(3, kRows);
  return {one_lag(), test::recording_of(u, residual), residual};
}

Confirmation says(const Cause& cause, const ChannelTests& before, const ChannelTests& after) {
  Effect effect;
  effect.edit = &cause;
  effect.place = {0, 0};
  return confirmation(effect, one_lag(), 1, before, after);
}

Confirmation says(const Cause& cause, double before, double after) {
  return says(cause, tests(before), tests(after));
}

TEST_CASE("a repair is borne out by as much as goes") {
  CHECK(says(causes::gain(), 0.5, 0.0) == Confirmation::kNothingOfAll);
  CHECK(says(causes::gain(), 0.5, 0.2) == Confirmation::kLess);
  CHECK(says(causes::gain(), 0.5, 0.5) == Confirmation::kNone);
  CHECK(says(causes::gain(), 0.3, 0.5) == Confirmation::kNone);
}

TEST_CASE("where the test saw nothing there is nothing to bear out") {
  CHECK(says(causes::gain(), 0.0, 0.3) == Confirmation::kLess);
}

TEST_CASE("a stuck actuator leaves nothing that answers it") {
  CHECK(says(causes::input_stuck(), 0.5, 0.0) == Confirmation::kNothing);
  CHECK(says(causes::input_stuck(), 0.5, 0.2) == Confirmation::kNone);
}

TEST_CASE("a repaired valve that sticks leaves the test clearly less to see") {
  CHECK(says(causes::stiction(), 0.5, 0.0) == Confirmation::kNothing);
  CHECK(says(causes::stiction(), 0.5, 0.3) == Confirmation::kNothing);
  CHECK(says(causes::stiction(), 0.5, 0.6) == Confirmation::kNone);
  // Less in the CV's units, but it stands out of less noise: nothing is repaired.
  const ChannelTests loud = tests(0.05, 0.3), quiet = tests(0.03, 0.05);
  REQUIRE(quiet.wrong(0, 0) < 0.5 * loud.wrong(0, 0));
  REQUIRE(quiet.p_value(0, 0).value() < 1e-2 * loud.p_value(0, 0).value());
  CHECK(says(causes::stiction(), loud, quiet) == Confirmation::kNone);
}

// One right repair in twenty leaves a p-value below 0.05 by chance.
TEST_CASE("of much that is surely wrong a trace may be left") {
  const double trace = 0.006;
  const ChannelTests left = tests(trace);
  REQUIRE(left.p_value(0, 0).value() > 1e-3);
  REQUIRE(left.p_value(0, 0).value() < 0.05);
  CHECK(says(causes::gain(), 0.5, trace) == Confirmation::kTrace);
  CHECK(says(causes::gain(), 0.01, trace) < Confirmation::kTrace);
}

TEST_CASE("what is surely wrong and too small to matter is no reason to accuse") {
  REQUIRE(tests(0.03).p_value(0, 0).value() < 1e-6);
  CHECK(says(causes::gain(), 0.03, 0.0) == Confirmation::kNothing);
}

TEST_CASE(
    "the test's word is enough for an error of a channel, and not for its absence or a curve") {
  const auto may = [](const Cause& cause, double low, double high) {
    Finding finding;
    finding.subject.cause = &cause;
    finding.parameters.push_back({&kGainRatio, 0.5 * (low + high), low, high});
    return is_channel_error(finding);
  };
  CHECK(may(causes::gain(), 0.3, 0.6));
  CHECK(may(causes::input_scale(), 1.2, 1.4));
  CHECK_FALSE(may(causes::gain(), -0.02, 0.1));
  CHECK_FALSE(may(causes::input_polynomial(), 0.3, 0.6));
  CHECK_FALSE(may(causes::cubic_stiffness(), 0.9, 1.1));
  CHECK_FALSE(may(causes::stiction(), 0.9, 1.1));
  Finding late;
  late.subject.cause = &causes::dead_time();
  CHECK(is_channel_error(late));
}

}  // namespace
}  // namespace mpm::confirmation_test
