#include "sim/plant/recovery_boiler/instruments.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::sim::boiler {
namespace {

TEST_CASE("low-level loops bring their flows where the set-points are") {
  Instruments plant;
  SetPoints setpoints;
  plant.advance(setpoints, {}, {}, 100);
  CHECK(plant.readings().steam_flow == Approx(389.0).margin(0.5));
  setpoints = {35.0, 140.0, 132.0, 31.0};
  plant.advance(setpoints, {}, {}, 60);
  CHECK(plant.readings().tertiary == Approx(35.0).margin(0.1));
  CHECK(plant.readings().liquor == Approx(140.0).margin(0.1));
  CHECK(plant.readings().spray_valve == Approx(31.0).margin(0.1));
  plant.advance(setpoints, {}, {}, 900);
  CHECK(plant.readings().liquor_temperature == Approx(132.0).margin(0.05));
  CHECK(plant.boiler().states()[kDrumMass] == Approx(kDrumWater).epsilon(0.01));
}

TEST_CASE("a set-point beyond an actuator leaves no windup") {
  Instruments plant;
  SetPoints setpoints;
  setpoints.tertiary = 70.0;  // the fan gives 60
  plant.advance(setpoints, {}, {}, 600);
  CHECK(plant.readings().tertiary == Approx(kFullAir).margin(0.1));
  setpoints.tertiary = 40.0;
  plant.advance(setpoints, {}, {}, 40);
  CHECK(plant.readings().tertiary == Approx(40.0).margin(0.5));
}

TEST_CASE("analysers are late, a thermowell is slow") {
  Instruments plant;
  SetPoints setpoints;
  plant.advance(setpoints, {}, {}, 10);
  const Readings before = plant.readings();
  setpoints.tertiary = 33.0;
  plant.advance(setpoints, {}, {}, kCOLine);
  CHECK(plant.readings().co == Approx(before.co).epsilon(1e-4));
  CHECK(plant.readings().excess_o2 > before.excess_o2 + 0.02);  // its line is shorter
  plant.advance(setpoints, {}, {}, 100);
  CHECK(plant.readings().co < before.co - 5.0);
}

TEST_CASE("faults of instruments do what they say") {
  Instruments plant;
  Faults faults;
  faults.valve_stiction = 0.5;
  faults.o2_offset = 0.3;
  SetPoints setpoints;
  setpoints.spray_valve = 30.4;
  plant.advance(setpoints, {}, faults, 100);
  CHECK(plant.readings().spray_valve == Approx(30.0));
  CHECK(plant.readings().excess_o2 == Approx(5.88 + 0.3).margin(0.01));
  setpoints.spray_valve = 30.6;
  plant.advance(setpoints, {}, faults, 100);
  CHECK(plant.readings().spray_valve == Approx(30.6));
  Condition leaking;
  leaking.air_leak = 2.0;
  const double o2 = plant.readings().excess_o2;
  plant.advance(setpoints, leaking, faults, 300);
  CHECK(plant.readings().tertiary == Approx(30.0).margin(0.01));
  CHECK(plant.readings().excess_o2 > o2 + 0.1);
}

}  // namespace
}  // namespace mpm::sim::boiler
