#include "daemon/bus/trouble.hpp"

#include <algorithm>

#include "core/text/number_text.hpp"

namespace mpm::bus {

const char* to_string(Severity severity) {
  switch (severity) {
    case Severity::kMaintenanceRequired:
      return "maintenance_required";
    case Severity::kFunctionCheck:
      return "function_check";
    case Severity::kOutOfSpecification:
      return "out_of_specification";
    default:
      return "failure";
  }
}

std::string alarms_text(std::uint64_t active, std::uint64_t silenced) {
  if (silenced == 0) return counted(active, "alarm");
  if (silenced >= active) return counted(silenced, "silenced alarm");
  return counted(active - silenced, "alarm") + ", " + std::to_string(silenced) + " silenced";
}

std::string troubles_in(const std::string& detail, std::uint32_t active_alarms,
                        std::uint32_t silenced_alarms) {
  const std::string alarms = alarms_text(active_alarms, silenced_alarms);
  if (detail.ends_with("; " + alarms)) return detail.substr(0, detail.size() - alarms.size() - 2);
  for (const std::string& first :
       {alarms, std::string(kNoCompleteData), std::string(kNothingDetermined)}) {
    if (detail == first) return "";
    if (detail.starts_with(first + "; ")) return detail.substr(first.size() + 2);
  }
  return detail;
}

void sort_by_severity(std::vector<Trouble>& troubles) {
  std::stable_sort(troubles.begin(), troubles.end(),
                   [](const Trouble& a, const Trouble& b) { return a.severity > b.severity; });
}

std::string joined_text(const std::vector<Trouble>& troubles, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < troubles.size() && i < most; ++i)
    text += (text.empty() ? "" : "; ") + troubles[i].text;
  if (troubles.size() > most) text += "; " + std::to_string(troubles.size() - most) + " more";
  return text;
}

}  // namespace mpm::bus
