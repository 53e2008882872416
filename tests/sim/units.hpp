#pragma once

#include <stdexcept>
#include <string>

#include "config/load_unit.hpp"
#include "sim/loop/closed_loop.hpp"

namespace mpm::test {

inline config::UnitConfig load_plant(const std::string& name) {
  config::LoadResult loaded =
      config::load_unit(std::string(MPM_SOURCE_DIR) + "/config/plants/" + name + ".yaml");
  if (!loaded.ok()) throw std::runtime_error("the shipped plant " + name + " does not load");
  return loaded.config;
}

/// Nothing hidden, the controller knows the plant.
inline sim::LoopSetup healthy_loop(const config::UnitConfig& unit, std::uint64_t seed = 1) {
  sim::LoopSetup setup;
  setup.unit = unit;
  setup.controller_model = unit.model;
  setup.seed = seed;
  return setup;
}

inline config::UnitConfig without_noise(config::UnitConfig unit) {
  for (config::NoiseSettings& noise : unit.simulation.noise) noise.sigma = 0.0;
  for (config::NoiseSettings& movement : unit.simulation.dv_movement) movement.sigma = 0.0;
  return unit;
}

inline config::Change gain_change(const std::string& cv, const std::string& mv, double ratio,
                                  double from_s = 0.0) {
  config::Change change;
  change.cv = cv;
  change.mv = mv;
  change.gain_ratio = ratio;
  change.from_s = from_s;
  return change;
}

}  // namespace mpm::test
