#include "tests/nonlinear/cases.hpp"

#include <utility>

namespace mpm::nonlinear {
namespace {

Case healthy(const std::string& scenario, const std::string& unit = "shell3x3") {
  Case made;
  made.name = unit + "_" + scenario;
  made.unit = unit;
  made.scenario = scenario;
  return made;
}

Case linear(const std::string& what, double gain, double time_constant, double dead_time_s, int cv,
            int input) {
  Case made;
  made.name = "linear_" + what + "_y" + std::to_string(cv + 1) + "u" + std::to_string(input + 1);
  made.truth = Truth::kLinear;
  made.changes = {{.cv = cv,
                   .input = input,
                   .gain_ratio = gain,
                   .time_constant_ratio = time_constant,
                   .dead_time_error_s = dead_time_s}};
  return made;
}

Case bent(const std::string& scenario, std::vector<int> channels) {
  Case made;
  made.name = scenario;
  made.scenario = scenario;
  made.truth = Truth::kNonlinear;
  made.nonlinear = std::move(channels);
  return made;
}

}  // namespace

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const char* scenario : {"none", "noise_x3", "sensor_noise", "periodic", "coupled_noise",
                               "heavy_tails", "all_events", "step_large", "ramp", "drift"})
    cases.push_back(healthy(scenario));
  for (const char* unit : {"wood_berry", "ogunnaike_ray", "shell7x5", "integrating_tank"})
    cases.push_back(healthy("none", unit));
  for (const auto& [cv, input] : {std::pair{0, 0}, {1, 2}, {2, 2}}) {
    cases.push_back(linear("gain+50", 1.5, 1.0, 0.0, cv, input));
    cases.push_back(linear("gain-50", 0.5, 1.0, 0.0, cv, input));
    cases.push_back(linear("lag+50", 1.0, 1.5, 0.0, cv, input));
    cases.push_back(linear("lag-50", 1.0, 0.5, 0.0, cv, input));
    cases.push_back(linear("delay+3", 1.0, 1.0, 3.0, cv, input));
  }
  cases.push_back(bent("quadratic_valve", {3, 4, 5}));
  cases.push_back(bent("valve_saturation", {0, 1, 2}));
  cases.push_back(bent("sticking_valve", {3, 4, 5}));
  cases.push_back(bent("valve_deadband", {3, 4, 5}));
  cases.push_back(bent("gain_and_saturation", {0, 1, 2}));
  cases.push_back(bent("operating_point_gain", {4}));
  cases.push_back(bent("output_clipping", {0, 3, 6}));
  cases.push_back(bent("square_root_flow", {8}));
  cases.push_back(bent("product_of_inputs", {3, 4, 5, 6, 7, 8}));
  cases.push_back(bent("directional_gain", {0, 1, 2}));
  return cases;
}

}  // namespace mpm::nonlinear
