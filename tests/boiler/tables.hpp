#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "tests/boiler/live_run.hpp"
#include "tests/boiler/thesis.hpp"

namespace mpm::boiler {

/// Indices of control under the head of their column: ours, or the thesis's.
struct ControlColumn {
  std::string head;
  thesis::Control control;
};
/// Of what `mpm detect` says of a run.
[[nodiscard]] thesis::Control control_of(const Json& detect);

/// One table of the variances of the control error, one of the time at limits.
[[nodiscard]] Json control_tables(const config::UnitConfig& unit,
                                  const std::vector<ControlColumn>& columns);

/// Verdicts, CVs by MVs, with since when an alarm stands.
[[nodiscard]] Json verdict_table(const std::string& title, const config::UnitConfig& unit,
                                 const Json& detect);

/// Alarms that stand at the end: "FC-301.SP \u2192 AI-602.PV since 3 h"; "none".
[[nodiscard]] std::string alarms_said(const Json& detect);

[[nodiscard]] int count_of(const Json& detect, const std::string& verdict);

/// "Sticking valve: HV-501.SP"
[[nodiscard]] std::string place_of(const Json& finding);

}  // namespace mpm::boiler
