#include "daemon/live/unit_samples.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "config/load_unit.hpp"
#include "config/whole_file.hpp"
#include "core/monitor/cost.hpp"
#include "core/text/netstring.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/folder_name.hpp"
#include "daemon/live/sample_log.hpp"

namespace mpm::live {
namespace {

// What a CV can start afresh from, and what went before it, from which the rest was learnt.
constexpr double kTimesRemembered = 2.0;
// By estimate; three times that is still within the patience of systemd.
constexpr double kMostSecondsToJudge = 10.0;
constexpr double kMostSecondsBehindState = 0.5;
// Of the log: the one before the last state is to be of use, too.
constexpr std::uint64_t kMostFilesBetween = SampleLog::kFiles / 4;

std::string identity_of(const std::string& text) {
  const auto sum = ::crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size());
  return std::to_string(text.size()) + ":" + std::to_string(sum);
}

std::string identity_of_program() {
  std::string why;
  return identity_of(config::read_whole_file("/proc/self/exe", why).value_or(""));
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
  return text + identity_of(model.str());  // which may be megabytes, and each file has a copy
}

std::string owner_of_state(const config::UnitConfig& unit) {
  static const std::string program = identity_of_program();
  std::ostringstream text;
  config::print_unit(unit, text);
  return program + ";" + identity_of(text.str());
}

UnitSamples samples_of(const config::UnitConfig& unit, std::size_t units,
                       const std::string& folder) {
  const MonitorCost cost = monitor_cost(unit.model, unit.monitor);
  const double seconds = cost.seconds * static_cast<double>(units);
  const double wanted = std::max(kTimesRemembered * cost.remembered,
                                 static_cast<double>(unit.monitor.diagnosis_samples));
  const double kept = std::max(1.0, std::min(wanted, kMostSecondsToJudge / seconds));
  const double files = kMostSecondsBehindState / seconds * SampleLog::kFiles / kept;
  return {folder + "/" + files::folder_name(unit.unit), meaning_of(unit), owner_of_state(unit),
          static_cast<std::uint64_t>(kept),
          static_cast<std::uint64_t>(std::clamp(files, 1.0, double{kMostFilesBetween}))};
}

}  // namespace mpm::live
