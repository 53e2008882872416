#include "sim/plant/recovery_boiler/running_boiler.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace mpm::sim::boiler {
namespace {

/// Inputs and conditions within what operation does, another each time.
struct Draw {
  std::mt19937_64 engine{17};
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  Inputs inputs() {
    return {between(15.0, 45.0), between(125.0, 145.0), between(125.0, 135.0), between(3.0, 12.0),
            between(90.0, 110.0)};
  }
  Condition condition() {
    return {between(0.8, 1.2), between(0.8, 1.0), between(0.62, 0.68), between(0.7, 1.3),
            between(0.0, 3.0)};
  }
};

// Carlsson (2010), Table 5.4.
TEST_CASE("the boiler rests at the operating point of the thesis") {
  const RunningBoiler boiler;
  const Streams& now = boiler.streams();
  CHECK(now.steam_flow == Approx(389.0).margin(0.5));
  CHECK(now.steam_temperature == Approx(444.0).margin(0.2));
  CHECK(now.excess_o2 == Approx(5.88).margin(0.01));
  CHECK(now.co == Approx(272.0).margin(0.5));
  // What real boilers make of a kilogram of dry solids: 3.2 to 3.75 kg of steam.
  const double solids = kLiquor * kLiquorDensity * kSolids / 1000.0;  // t/h
  CHECK(now.steam_flow / solids > 3.2);
  CHECK(now.steam_flow / solids < 3.75);
}

// Carlsson (2010), figure 5.2, of which the axes can be read: the response after 200 samples of 10
// s lies between half of an axis' end and one and a half of it.
TEST_CASE("step responses have the signs and sizes of the thesis") {
  struct Response {
    const char* input;
    double steam_flow, steam_temperature, excess_o2, co;  // 0: not read, or none
  };
  const Response given =
      GENERATE(Response{"air", -0.8, -0.4, 0.08, -4.0}, Response{"liquor", 2.0, 0.6, -0.08, 6.0},
               Response{"temperature", -0.6, 0.0, -0.02, 2.0},
               Response{"attemperator", 10.0, -15.0, 0.0, 0.0});
  CAPTURE(given.input);
  const std::string input = given.input;
  RunningBoiler boiler;
  const Streams before = boiler.streams();
  Inputs inputs;
  inputs.tertiary += input == "air" ? 1.0 : 0.0;
  inputs.liquor += input == "liquor" ? 1.0 : 0.0;
  inputs.liquor_temperature += input == "temperature" ? 1.0 : 0.0;
  inputs.spray += input == "attemperator" ? kSprayPerPercent : 0.0;
  for (int second = 0; second < 2000; ++second) {
    inputs.feedwater =
        boiler.streams().drum_flow + (kDrumWater - boiler.states()[kDrumMass]) / 100.0;
    boiler.advance(inputs, {}, 1.0);
  }
  const auto check = [](double change, double axis) {
    if (axis == 0.0) return;
    CHECK(change / axis > 0.5);
    CHECK(change / axis < 1.5);
  };
  const Streams& after = boiler.streams();
  check(after.steam_flow - before.steam_flow, given.steam_flow);
  check(after.steam_temperature - before.steam_temperature, given.steam_temperature);
  check(after.excess_o2 - before.excess_o2, given.excess_o2);
  check(after.co - before.co, given.co);
  if (input == "temperature") CHECK(after.steam_temperature < before.steam_temperature);
  if (input == "attemperator") {  // fourteen of sixteen channels exist
    CHECK(after.excess_o2 == Approx(before.excess_o2).epsilon(1e-6));
    CHECK(after.co == Approx(before.co).epsilon(1e-6));
  }
}

TEST_CASE("mass, carbon and energy are conserved at every moment") {
  Draw draw;
  for (int n = 0; n < 200; ++n) {
    States states = first_guess();
    for (double& state : states) state *= draw.between(0.9, 1.1);
    const Moment now = moment(states, draw.inputs(), draw.condition());
    // What the contents gain: their slope along the rates, by a central difference, of contents
    // that are linear in the states.
    const auto gained = [&](double Contents::*what) {
      States after = states, before = states;
      for (std::size_t i = 0; i < kStates; ++i) {
        after[i] += 0.5 * now.rates[i];
        before[i] -= 0.5 * now.rates[i];
      }
      return contents(after).*what - contents(before).*what;
    };
    const Streams& flows = now.streams;
    CHECK(gained(&Contents::mass) ==
          Approx(flows.mass_in - flows.mass_out).margin(1e-6 * flows.mass_in));
    CHECK(gained(&Contents::carbon) ==
          Approx(flows.carbon_in - flows.carbon_out).margin(1e-6 * flows.carbon_in));
    CHECK(gained(&Contents::energy) ==
          Approx(flows.energy_in - flows.energy_out).margin(1e-6 * flows.energy_in));
  }
}

/// Every minute another input; CVs each 10 s.
std::vector<Streams> moved(double tolerance) {
  Draw draw;
  RunningBoiler boiler({}, {}, tolerance);
  std::vector<Streams> seen;
  Inputs inputs;
  for (int second = 0; second < 1200; ++second) {
    if (second % 60 == 0) inputs = draw.inputs();
    inputs.feedwater =
        boiler.streams().drum_flow + (kDrumWater - boiler.states()[kDrumMass]) / 100.0;
    boiler.advance(inputs, {}, 1.0);
    if (second % 10 == 9) seen.push_back(boiler.streams());
  }
  return seen;
}

TEST_CASE("half the tolerance changes nothing that anyone could see") {
  const std::vector<Streams> usual = moved(1e-7), half = moved(5e-8);
  double worst = 0.0;
  for (std::size_t k = 0; k < usual.size(); ++k)
    for (double Streams::*what : {&Streams::steam_flow, &Streams::steam_temperature,
                                  &Streams::excess_o2, &Streams::co, &Streams::pressure})
      worst = std::max(worst, std::abs(half[k].*what / (usual[k].*what) - 1.0));
  CHECK(worst < 1e-5);
}

TEST_CASE("the boiler is nonlinear: the same air takes less CO where there is more of it") {
  const auto co = [](double air) {
    Inputs inputs;
    inputs.tertiary = air;
    return RunningBoiler(inputs).streams().co;
  };
  const double fall_below = co(15.0) - co(30.0), fall_above = co(30.0) - co(45.0);
  CHECK(fall_below > 1.5 * fall_above);
}

TEST_CASE("what is hidden in the boiler does what it should") {
  const Streams usual = RunningBoiler().streams();
  Condition condition;
  condition.oxidation = 1.1;
  const Streams quicker = RunningBoiler({}, condition).streams();
  CHECK(quicker.co == Approx(usual.co / 1.1).epsilon(0.02));  // of a stirred gas, nearly all burnt
  CHECK(quicker.steam_temperature == Approx(usual.steam_temperature).margin(0.1));
  condition = {};
  condition.superheating = 0.9;
  CHECK(RunningBoiler({}, condition).streams().steam_temperature < usual.steam_temperature - 3.0);
  condition = {};
  condition.solids = kSolids * 1.02;
  const Streams drier = RunningBoiler({}, condition).streams();
  CHECK(drier.steam_flow > usual.steam_flow + 3.0);
  CHECK(drier.excess_o2 < usual.excess_o2 - 0.1);
  condition = {};
  condition.air_leak = 2.0;
  CHECK(RunningBoiler({}, condition).streams().excess_o2 > usual.excess_o2 + 0.1);
}

}  // namespace
}  // namespace mpm::sim::boiler
