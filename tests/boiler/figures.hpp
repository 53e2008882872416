#pragma once

#include <string>
#include <vector>

#include "tests/boiler/samples.hpp"

namespace mpm::boiler {

using report::Json;

/// Signals of one run, and how they are drawn.
struct Drawn {
  std::string name;
  report::Role role;
  const Samples& samples;
};

/// The CVs above each other, their set-points dotted: figures 5.3 and 5.5.
[[nodiscard]] Json cv_figure(const std::string& title, const config::UnitConfig& unit,
                             const std::vector<Drawn>& runs);
/// The MVs above each other, their limits dotted: figures 5.4 and 5.6.
[[nodiscard]] Json mv_figure(const std::string& title, const config::UnitConfig& unit,
                             const std::vector<Drawn>& runs);
/// CVs as measured and as the model gives them in free run.
[[nodiscard]] Json free_run_figure(const std::string& title, const config::UnitConfig& unit,
                                   const Samples& measured,
                                   const std::vector<report::Series>& simulated);
/// Step responses with their bands, CV by MV, as in figure 5.2; a text where there is none.
[[nodiscard]] Json step_responses(const config::UnitConfig& unit, const Json& identified);

}  // namespace mpm::boiler
