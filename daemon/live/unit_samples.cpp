#include "daemon/live/unit_samples.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "config/load_unit.hpp"
#include "core/monitor/cost.hpp"
#include "core/text/netstring.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/folder_name.hpp"

namespace mpm::live {
namespace {

// What a CV can start afresh from, and what went before it, from which the rest was learnt.
constexpr double kTimesRemembered = 2.0;
// By estimate; three times that is still within the patience of systemd.
constexpr double kMostSecondsToJudge = 10.0;

std::uint64_t kept_intervals(const config::UnitConfig& unit, std::size_t units) {
  const double most_seconds = kMostSecondsToJudge / static_cast<double>(units);
  const MonitorCost cost = monitor_cost(unit.model, unit.monitor);
  const double wanted = std::max(kTimesRemembered * cost.remembered,
                                 static_cast<double>(unit.monitor.diagnosis_samples));
  return static_cast<std::uint64_t>(std::max(1.0, std::min(wanted, most_seconds / cost.seconds)));
}

}  // namespace

// A repaired model is not to be judged by the predictions of the one before.
std::string meaning_of(const config::UnitConfig& unit) {
  std::string text = number_text(unit.sample_time_s);
  bool predicted = false;
  for (const auto* signals : {&unit.mv, &unit.dv, &unit.aux, &unit.raw}) {
    text += ';';
    for (const config::InputSignal& signal : *signals) append_netstring(text, signal.tag);
  }
  text += ';';
  for (const config::CvSignal& cv : unit.cv) {
    for (const std::string& tag : {cv.tag, cv.prediction, cv.setpoint}) append_netstring(text, tag);
    predicted = predicted || !cv.prediction.empty();
  }
  if (!predicted) return text;
  std::ostringstream model;
  config::print_model_section(unit, model);
  const std::string whole = model.str();  // may be megabytes, of which each file would keep a copy
  const auto sum = ::crc32_z(0, reinterpret_cast<const Bytef*>(whole.data()), whole.size());
  return text + std::to_string(whole.size()) + ":" + std::to_string(sum);
}

SampleLog samples_of(const config::UnitConfig& unit, std::size_t units, const std::string& folder) {
  return {folder + "/" + files::folder_name(unit.unit), meaning_of(unit),
          kept_intervals(unit, units)};
}

}  // namespace mpm::live
