#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario_config.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// What to compare two controller models on.
struct LoopPlan {
  std::string program;  ///< mpmsim
  std::string config;   ///< unit file
  std::string scenario;
  config::ScenarioConfig loaded;  ///< it, read
  std::vector<std::uint64_t> seeds;
};

/// Checks all that can be checked before a diagnosis begins. `seed`: as the user gave it, if at
/// all. Throws config::InputError or SimulatorError; nothing where the scenario's file is wrong,
/// whose findings go to `findings`.
[[nodiscard]] std::optional<LoopPlan> plan_loops(const config::UnitConfig& unit,
                                                 const std::string& config_file,
                                                 const std::string& scenario,
                                                 std::optional<std::uint64_t> seed,
                                                 std::vector<config::Finding>& findings);

/// Runs the plan with the unit file's model in the controller and with the extended one, which does
/// without inputs that the unit does not have: the simulated plant does not measure them. Throws
/// SimulatorError where a run fails or `stopped` says so.
[[nodiscard]] ClosedLoop compare_loops(const LoopPlan& plan, const config::UnitConfig& unit,
                                       const Diagnosis& diagnosis,
                                       const std::function<bool()>& stopped);

}  // namespace mpm::report
