#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <stdexcept>

#include "sim/mpc/linear_gain.hpp"
#include "sim/scenario/prepare.hpp"
#include "sim/scenario/random_change.hpp"
#include "sim/scenario/stability.hpp"
#include "tests/sim/units.hpp"

namespace {

using mpm::config::UnitConfig;
using mpm::sim::ChannelChange;
using mpm::sim::compare_gains;
using mpm::sim::GainAgreement;
using mpm::sim::hide_changes;
using mpm::sim::LoopSetup;
using mpm::test::gain_change;
using mpm::test::healthy_loop;
using mpm::test::load_plant;

GainAgreement agreement(const std::vector<mpm::config::Change>& changes) {
  const UnitConfig unit = load_plant("shell3x3");
  const auto changed =
      mpm::sim::changed_model(unit.model, mpm::sim::resolve_changes(changes, unit));
  return compare_gains(mpm::sim::operating_gain(unit.model, 3),
                       mpm::sim::operating_gain(changed, 3), {});
}

}  // namespace

TEST_CASE("the determinant of Shell's gains tells which changes can be run") {
  // By hand from eq. 4.1: det 20.85, cofactors of (y1,u1) 10.686, (y2,u1) 13.2456 and (y2,u3)
  // -10.1484, so -0.25 (4.05 * 10.686 + 5.39 * 13.2456) = -28.67 and 0.4 * 6.9 * 10.1484 = 28.01.
  const GainAgreement none = agreement({});
  CHECK(*none.model_determinant == Approx(20.85).epsilon(1e-3));
  CHECK(none.smallest_real_part == Approx(1.0));

  const GainAgreement s2 =
      agreement({gain_change("y1", "u1", 0.75), gain_change("y2", "u1", 0.75)});
  CHECK(*s2.plant_determinant == Approx(-7.8).epsilon(0.01));
  CHECK_FALSE(s2.stabilisable());

  const GainAgreement more = agreement({gain_change("y2", "u3", 1.4)});
  CHECK(*more.plant_determinant == Approx(-7.2).epsilon(0.01));
  CHECK_FALSE(more.stabilisable());

  const GainAgreement less = agreement({gain_change("y2", "u3", 0.6)});
  CHECK(*less.plant_determinant == Approx(48.86).epsilon(1e-3));
  CHECK(less.stabilisable(0.2));
}

TEST_CASE("gains that are not square are compared where the controller can reach") {
  Eigen::MatrixXd wide(1, 2), tall(2, 1);
  wide << 2.0, 1.0;
  tall << 2.0, 1.0;
  CHECK(compare_gains(wide, wide, {}).smallest_real_part == Approx(1.0));
  CHECK(compare_gains(wide, -wide, {}).smallest_real_part == Approx(-1.0));
  CHECK(compare_gains(tall, tall, {}).smallest_real_part == Approx(1.0));
  CHECK_FALSE(compare_gains(tall, tall, {}).model_determinant.has_value());
  // K_model^+ K_plant = (2 * 2 - 3 * 1) / 5 with equal weights; the second CV counts 4 times with
  // weights (1, 4): (2 * 2 - 4 * 3) / 8.
  Eigen::MatrixXd turned(2, 1);
  turned << 2.0, -3.0;
  CHECK(compare_gains(tall, turned, {}).smallest_real_part == Approx(0.2));
  CHECK(compare_gains(tall, turned, {1.0, 4.0}).smallest_real_part == Approx(-1.0));
}

TEST_CASE("an integrating channel outweighs all others of its CV") {
  UnitConfig unit = load_plant("shell3x3");
  auto& transfer = std::get<mpm::TransferFunction>(unit.model.channels[0].dynamics);
  transfer.integrating = true;
  const Eigen::MatrixXd gain = mpm::sim::operating_gain(unit.model, 3);
  CHECK(gain(0, 0) == Approx(4.05));
  CHECK(gain(0, 1) == 0.0);
  CHECK(gain(0, 2) == 0.0);
}

TEST_CASE("a plant that the controller cannot hold is refused with its determinants") {
  LoopSetup setup = healthy_loop(load_plant("shell3x3"));
  setup.scenario.changes = {gain_change("y1", "u1", 0.75, 500.0),
                            gain_change("y2", "u1", 0.75, 500.0)};
  try {
    hide_changes(setup);
    FAIL("accepted");
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    CAPTURE(message);
    CHECK(message.find("20.8 in the model") != std::string::npos);
    CHECK(message.find("-7.82 in the plant") != std::string::npos);
    CHECK(message.find("from 500 s on") != std::string::npos);
  }
  // Without integral action it runs.
  setup.scenario.integral_action = false;
  setup.scenario.disturbance_feedback = 0.5;
  CHECK_NOTHROW(hide_changes(setup));
  CHECK(mpm::sim::feedback_share(setup.scenario) == 0.5);
  // And with the plant's gains below the model's 1 / 0.75 (det +59 in the model) it does too.
  setup = healthy_loop(load_plant("shell3x3"));
  setup.controller_model = mpm::sim::changed_model(
      setup.unit.model, {ChannelChange{0, 0, 1 / 0.75}, ChannelChange{1, 0, 1 / 0.75}});
  CHECK_NOTHROW(hide_changes(setup));
}

TEST_CASE("the thesis's scenario 2 as written is refused with integral action, its readings run") {
  const std::string scenarios = std::string(MPM_SOURCE_DIR) + "/config/scenarios/";
  const auto prepared = [&](const std::string& plant, const std::string& scenario) {
    LoopSetup setup = healthy_loop(load_plant(plant));
    const auto loaded = mpm::config::load_scenario(scenarios + scenario + ".yaml", setup.unit);
    REQUIRE(loaded.ok());
    setup.scenario = loaded.scenario;
    hide_changes(setup);
    return setup;
  };
  CHECK_THROWS_WITH(prepared("shell3x3", "s2_gain25"),
                    Catch::Matchers::Contains("20.8 in the model") &&
                        Catch::Matchers::Contains("-7.82 in the plant"));
  for (const auto& [plant, scenario] :
       {std::pair{"shell3x3", "s2_gain25_no_integral"}, std::pair{"shell3x3", "s2_gain25_limits"},
        std::pair{"shell3x3", "s2_gain15"}, std::pair{"shell3x3_high_model", "s2_gain25"}}) {
    CAPTURE(plant, scenario);
    const LoopSetup setup = prepared(plant, scenario);
    mpm::sim::ClosedLoop loop(setup);
    double largest_input = 0.0, largest_output = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const mpm::Frame& frame = loop.step();
      largest_input =
          std::max(largest_input, frame[mpm::SignalKind::kMv].values.cwiseAbs().maxCoeff());
      largest_output =
          std::max(largest_output, frame[mpm::SignalKind::kCv].values.cwiseAbs().maxCoeff());
    }
    CHECK(loop.finite());
    CHECK(largest_output < 5.0);
    const bool limited = std::string(scenario) == "s2_gain25_limits";
    CHECK(largest_input < (limited ? 1.5 + 1e-9 : 5.0));
    CHECK((setup.scenario.mv_limits.size() == 3) == limited);
  }
}

TEST_CASE("a drawn change is one that the loop can bear, and the seed decides", "[trials]") {
  LoopSetup setup = healthy_loop(load_plant("shell3x3"));
  setup.scenario.draw =
      mpm::config::RandomDraw{{0.6, 0.7, 1.3, 1.4}, {0.5, 2.0}, {-3.0, 4.0}, 100.0, 1};
  std::map<std::pair<int, int>, int> drawn;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    setup.seed = seed;
    hide_changes(setup);
    REQUIRE(setup.changes.size() == 1);
    const ChannelChange& change = setup.changes[0];
    ++drawn[{change.cv, change.input}];
    CHECK(change.from_s == 100.0);
    const int kinds = (change.gain_ratio != 1.0) + (change.time_constant_ratio != 1.0) +
                      (change.dead_time_error_s != 0.0);
    CHECK(kinds == 1);
    CHECK(mpm::sim::settles(setup));
    LoopSetup again = setup;
    hide_changes(again);
    CHECK(again.changes[0].cv == change.cv);
    CHECK(again.changes[0].input == change.input);
    CHECK(again.changes[0].gain_ratio == change.gain_ratio);
  }
  CHECK(drawn.size() >= 7);  // of 9 channels in 40 draws
}

TEST_CASE("several drawn changes are in different channels and bearable together") {
  LoopSetup setup = healthy_loop(load_plant("shell3x3"));
  setup.scenario.draw = mpm::config::RandomDraw{{0.7, 1.3}, {}, {}, 0.0, 3};
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    setup.seed = seed;
    hide_changes(setup);
    REQUIRE(setup.changes.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < i; ++j)
        CHECK((setup.changes[i].cv != setup.changes[j].cv ||
               setup.changes[i].input != setup.changes[j].input));
    CHECK(mpm::sim::settles(setup));
  }
}

TEST_CASE("a draw from what no channel can bear is refused") {
  LoopSetup setup = healthy_loop(load_plant("shell3x3"));
  setup.scenario.draw = mpm::config::RandomDraw{{-1.0}, {}, {-1000.0}, 0.0, 9};
  CHECK_THROWS_AS(hide_changes(setup), std::invalid_argument);
}

TEST_CASE("the controller's model is read by tags, not by order") {
  const UnitConfig plant = load_plant("wood_berry");
  UnitConfig other = plant;
  std::swap(other.mv[0], other.mv[1]);
  std::swap(other.cv[0], other.cv[1]);
  for (mpm::ChannelSpec& channel : other.model.channels) {
    channel.cv = 1 - channel.cv;
    if (channel.input < 2) channel.input = 1 - channel.input;
  }
  const mpm::ModelSpec matched = mpm::sim::match_signals(other, plant);
  CHECK(mpm::LinearModel(matched).steady_gain() == mpm::LinearModel(plant.model).steady_gain());
  CHECK(mpm::LinearModel(other.model).steady_gain() != mpm::LinearModel(plant.model).steady_gain());
  other.mv[0].tag = "unknown";
  CHECK_THROWS_AS(mpm::sim::match_signals(other, plant), std::invalid_argument);
  other = plant;
  other.sample_time_s = 30.0;
  CHECK_THROWS_AS(mpm::sim::match_signals(other, plant), std::invalid_argument);
}

TEST_CASE("a plant that no controller can hold is refused at the change that is too much") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("shell3x3"));
  setup.scenario.name = "s2";
  // det 20.85 -> 21.8 -> 10.7, and with the third -7.1 (by cofactors).
  setup.scenario.changes = {mpm::test::gain_change("y3", "u3", 1.01),
                            mpm::test::gain_change("y1", "u1", 0.75),
                            mpm::test::gain_change("y2", "u1", 0.75, 4321.0)};
  setup.scenario.changes[2].place = {"s2.yaml", 4, 5, "changes[2]"};
  try {
    hide_changes(setup);
    FAIL("was not refused");
  } catch (const mpm::sim::RefusedScenario& error) {
    const std::string told = mpm::config::format(error.finding());
    CAPTURE(told);
    CHECK(told.rfind("s2.yaml:4:5: error: changes[2]: no offset-free controller", 0) == 0);
    CHECK(told.find("from 4321 s on: the determinant of the gains is 20.8 in the model and -") !=
          std::string::npos);
  }
  // The first alone turns the determinant's sign (20.85 - 0.7 * 4.05 * 10.69); the row does not.
  setup.scenario.changes = {mpm::test::gain_change("y1", "u1", 0.30),
                            mpm::test::gain_change("y1", "u2", 0.30),
                            mpm::test::gain_change("y1", "u3", 0.30)};
  CHECK_NOTHROW(hide_changes(setup));
}
