#include "tests/boiler/hidden_changes.hpp"

#include <array>
#include <string_view>

namespace mpm::boiler {
namespace {

/// A finding that answers a scenario; `place`: its CV, MV or tag; `sign`: of its size, 0 = any.
struct Answer {
  std::string_view scenario, cause, place, judged;
  int sign = 0;
};

constexpr std::string_view kAnyScenario;

constexpr std::array kAnswers = {
    Answer{kAnyScenario, "input_nonlinearity", "AI-602.PV", "the plant's own, which is not linear"},
    Answer{"co_oxidation", "output_disturbance", "AI-602.PV",
           "its effect on the level of CO alone"},
    Answer{"fouled_superheater", "output_disturbance", "TI-502.PV",
           "its effect on the level of the steam temperature alone"},
    Answer{"sticking_spray_valve", "stiction", "HV-501.SP", "right"},
    Answer{"o2_analyser_drift", "output_disturbance", "AI-601.PV", "right"},
    Answer{"drier_liquor", "input_offset", "FC-101.SP", "acts alike: more solids are more fuel"},
    Answer{"drier_liquor", "unmodelled_input", "AI-103.PV", "right"},
    Answer{"growing_char_bed", "input_offset", "FC-101.SP",
           "acts alike: what stays on the bed is less fuel"},
    // Less burns until the bed has grown: oxygen is left, less turns to CO, steam is less and
    // colder.
    Answer{"growing_char_bed", "output_disturbance", "AI-602.PV", "its effect on CO", -1},
    Answer{"growing_char_bed", "output_disturbance", "AI-601.PV", "its effect on O2", 1},
    Answer{"growing_char_bed", "output_disturbance", "FI-500.PV", "its effect on the steam flow",
           -1},
    Answer{"growing_char_bed", "output_disturbance", "TI-502.PV",
           "its effect on the steam temperature", -1},
    Answer{"leaking_damper", "input_offset", "FC-301.SP", "right"},
    Answer{"leaking_damper", "output_disturbance", "AI-601.PV", "its effect on O2 alone"},
};

bool answers(const Answer& answer, const std::string& scenario, const Json& finding) {
  const bool hidden = answer.scenario == kAnyScenario || answer.scenario == scenario;
  if (!hidden || finding["cause"] != answer.cause) return false;
  if (answer.sign != 0 && finding["parameters"]["size"].get<double>() * answer.sign <= 0.0)
    return false;
  return finding["cv"] == answer.place || finding["mv"] == answer.place ||
         finding["tag"] == answer.place;
}

}  // namespace

std::string judged(const std::string& scenario, const Json& finding, const Json& healthy) {
  for (const Answer& answer : kAnswers)
    if (answers(answer, scenario, finding)) return std::string(answer.judged);
  if (scenario == "none") return "wrong";
  for (const Json& other : healthy["findings"])
    if (other["cause"] == finding["cause"] && other["cv"] == finding["cv"] &&
        other["mv"] == finding["mv"])
      return "found also where nothing is hidden";
  return "wrong";
}

}  // namespace mpm::boiler
