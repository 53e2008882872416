#include "tests/boiler/hidden_changes.hpp"

#include <array>
#include <string_view>

namespace mpm::boiler {
namespace {

/// A finding that answers a scenario; `place`: its CV, MV or tag.
struct Answer {
  std::string_view scenario, cause, place, judged;
};

constexpr std::array kAnswers = {
    Answer{"none", "input_nonlinearity", "AI-602.PV", "the plant's own, which is not linear"},
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
    Answer{"leaking_damper", "input_offset", "FC-301.SP", "right"},
    Answer{"leaking_damper", "output_disturbance", "AI-601.PV", "its effect on O2 alone"},
};

}  // namespace

std::string judged(const std::string& scenario, const Json& finding, const Json& healthy) {
  for (const Answer& answer : kAnswers) {
    if (answer.scenario != scenario || finding["cause"] != answer.cause) continue;
    for (const char* key : {"cv", "mv", "tag"})
      if (finding[key] == answer.place) return std::string(answer.judged);
  }
  if (scenario == "none") return "wrong";
  for (const Json& other : healthy["findings"])
    if (other["cause"] == finding["cause"] && other["cv"] == finding["cv"] &&
        other["mv"] == finding["mv"])
      return "found also where nothing is hidden";
  return "wrong";
}

}  // namespace mpm::boiler
