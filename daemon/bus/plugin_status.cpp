#include "daemon/bus/plugin_status.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/bus/trouble.hpp"

namespace mpm::bus {
namespace {

constexpr int kOk = 0, kWarning = 1, kCritical = 2;
constexpr std::array kWords = {"OK", "WARNING", "CRITICAL"};

// What people have silenced is not to be annunciated by another name.
std::uint32_t calling(const MonitorWord& unit) {
  return unit.active_alarms - std::min(unit.active_alarms, unit.silenced_alarms);
}

int code_of(const MonitorWord& unit, const AgeLimits& limits) {
  if (unit.state.empty() || unit.gone || unit.state == "failure" || unit.age_s >= limits.critical_s)
    return kCritical;
  return unit.state != "normal" || calling(unit) > 0 || unit.age_s >= limits.warning_s ? kWarning
                                                                                       : kOk;
}

std::string text_of(const MonitorWord& unit) {
  if (unit.state.empty())
    return unit.unit + ": no monitor" + (unit.place.empty() ? "" : " on " + unit.place);
  std::string text = unit.unit + ": " + unit.state;
  if (!unit.detail.empty()) text += " (" + unit.detail + ")";
  if (unit.gone) text += ", and its monitor has left";
  return text + fmt::format(", {:.1f} s ago", unit.age_s);
}

constexpr std::size_t kLongestStatus = 10'000;  // of many units

// Nothing of the bus gets to a terminal as it is; '|' begins the performance data, and a label ends
// at its quote.
std::string plain(const std::string& raw, bool label) {
  std::string text = label ? printable(raw) : printable(raw, kLongestStatus);
  std::replace_if(
      text.begin(), text.end(),
      [label](char c) { return c == '|' || (label && (c == '\'' || c == '=')); }, '_');
  return text;
}

std::string performance(const MonitorWord& unit, const AgeLimits& limits) {
  const std::string name = plain(unit.unit, true);
  if (unit.state.empty())  // U: not known
    return fmt::format(" '{0} alarms'=U '{0} age'=U '{0} state'=2;0;1", name);
  return fmt::format(" '{0} alarms'={1};0 '{0} age'={2:.1f}s;{3:g};{4:g} '{0} state'={5};0;1", name,
                     calling(unit), unit.age_s, limits.warning_s, limits.critical_s,
                     code_of(unit, limits));
}

}  // namespace

PluginStatus plugin_status(const std::vector<MonitorWord>& units, const AgeLimits& limits,
                           const std::string& place) {
  if (units.empty()) return {kCritical, "MPM CRITICAL: no monitor on " + plain(place, false)};
  int worst = kOk;
  std::uint64_t alarms = 0, silenced = 0;
  for (const MonitorWord& unit : units) {
    worst = std::max(worst, code_of(unit, limits));
    alarms += unit.active_alarms;
    silenced += unit.silenced_alarms;
  }
  std::string text, data;
  for (int code = worst; code > kOk; --code)
    for (const MonitorWord& unit : units)
      if (code_of(unit, limits) == code) text += (text.empty() ? "" : "; ") + text_of(unit);
  if (text.empty()) text = counted(units.size(), "unit") + ", " + alarms_text(alarms, silenced);
  for (const MonitorWord& unit : units) data += performance(unit, limits);
  return {worst, std::string("MPM ") + kWords.at(static_cast<std::size_t>(worst)) + ": " +
                     plain(text, false) + " |" + data};
}

}  // namespace mpm::bus
