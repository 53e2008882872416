#include <catch2/catch.hpp>
#include <string>

#include "config/load_unit.hpp"

namespace mpm::config {
namespace {

const std::string kUnit =
    "unit: u\nsample_time: 10\nsignals: {mv: [u1, u2], dv: [d1], cv: [y1, y2, y3]}\nmodel:\n"
    "  channels:\n"
    "    - {cv: y1, mv: u1, gain: 3, time_constants: [300]}\n"
    "    - {cv: y1, mv: u2, gain: -4, time_constants: [100]}\n"
    "    - {cv: y2, mv: u1, gain: 0.002, integrating: true}\n"
    "    - {cv: y3, dv: d1, gain: 1}\n";

// By hand: MVs by half a unit move y1 by 0.5 sqrt(3^2 + 4^2); y2 rises by 0.02 a sample for the 30
// samples of the slowest time constant.
TEST_CASE("a unit that says nothing of its simulation moves in proportion to its gains") {
  const SimulationSettings moved = load_unit_text(kUnit, "u.yaml").config.simulation;
  CHECK(moved.setpoints[0].amplitude == Approx(2.5));
  CHECK(moved.setpoints[0].hold_samples == 120);
  CHECK(moved.noise[0].sigma == Approx(0.05));
  CHECK(moved.setpoints[1].amplitude == Approx(0.3).epsilon(0.01));
  CHECK(moved.noise[2].sigma == 0.0);  // no MV moves it
  CHECK(moved.dv_movement[0].sigma > 0.0);
}

TEST_CASE("a simulation that is given is as it says") {
  const SimulationSettings given =
      load_unit_text(kUnit + "simulation: {prediction_horizon: 100}\n", "u.yaml").config.simulation;
  CHECK(given.noise[0].sigma == 0.0);
  CHECK(given.dv_movement[0].sigma == 0.0);
}

}  // namespace
}  // namespace mpm::config
