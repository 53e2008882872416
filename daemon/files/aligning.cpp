#include "daemon/files/aligning.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "config/unit_layout.hpp"

namespace mpm::files {

std::array<bool, kSignalKindCount> needed_kinds(const config::UnitConfig& unit) {
  std::array<bool, kSignalKindCount> needed{};
  const auto calculates_with = [&unit](const std::string& tag) {
    return std::any_of(unit.calc.begin(), unit.calc.end(), [&](const auto& signal) {
      return std::find(signal.inputs.begin(), signal.inputs.end(), tag) != signal.inputs.end();
    });
  };
  for (std::size_t k = 0; k < kSignalKindCount; ++k) {
    const auto kind = static_cast<SignalKind>(k);
    if (kind == SignalKind::kAux) continue;
    for (const std::string& tag : measured_tags_of(unit, kind))
      needed[k] =
          needed[k] || (!tag.empty() && (kind != SignalKind::kSetpoint || calculates_with(tag)));
  }
  return needed;
}

AlignerSettings aligner_settings(const config::UnitConfig& unit) {
  AlignerSettings settings;
  settings.sample_time_ns = 1e9 * unit.sample_time_s;
  for (const std::string& tag : measured_tags_of(unit, SignalKind::kSetpoint))
    if (!tag.empty()) settings.welcome[static_cast<std::size_t>(SignalKind::kSetpoint)] = true;
  return settings;
}

std::chrono::nanoseconds frame_patience(const config::UnitConfig& unit) {
  using std::chrono::duration;
  const duration<double> lateness(unit.sample_time_s * AlignerSettings{}.max_lateness);
  return std::max<std::chrono::nanoseconds>(
      std::chrono::seconds(2), std::chrono::duration_cast<std::chrono::nanoseconds>(lateness));
}

}  // namespace mpm::files
