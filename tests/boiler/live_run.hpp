#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/boiler/workshop.hpp"

namespace mpm::boiler {

using Json = nlohmann::ordered_json;

inline const std::string kPlant = "config/plants/recovery_boiler.yaml";

/// A run in closed loop.
struct LivePlan {
  std::string name;      ///< of its files
  std::string scenario;  ///< what is hidden in the plant
  std::string model;     ///< unit file whose model controller and monitor have
  int samples = 0;
  std::uint64_t seed = 0;
};

struct LiveRun {
  std::string recording;
  Json detect;               ///< what `mpm detect --json` says of the recording
  bool same_answer = false;  ///< mpmd had published the same of every channel
  std::vector<Command> commands;
};

/// Plays it over DDS: mpmsim publishes, mpmd monitors, `mpm record` records; then `mpm detect`
/// reads the recording. Throws StoryError.
[[nodiscard]] LiveRun play_live(Workshop& workshop, const LivePlan& plan);

}  // namespace mpm::boiler
