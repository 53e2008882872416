#pragma once

#include <string>
#include <vector>

#include "sim/plant/channel_change.hpp"

/// What the nonlinear test is scored on.
namespace mpm::nonlinear {

/// What is true of a unit.
enum class Truth {
  kHealthy,    ///< the model is right: disturbances only
  kLinear,     ///< some channel has a linear error
  kNonlinear,  ///< some input, channel or CV is nonlinear
};

struct Case {
  std::string name;
  std::string unit = "shell3x3";  ///< file in config/plants
  std::string scenario = "none";  ///< file in config/scenarios, or `none`
  Truth truth = Truth::kHealthy;
  std::vector<sim::ChannelChange> changes = {};  ///< beside those of the scenario
  /// Channels that are nonlinear, input * CVs + CV; the others are linear, right or wrong.
  std::vector<int> nonlinear = {};
};

[[nodiscard]] std::vector<Case> all_cases();

}  // namespace mpm::nonlinear
