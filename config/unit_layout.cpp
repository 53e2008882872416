#include "config/unit_layout.hpp"

#include <algorithm>

namespace mpm::config {

UnitLayout unit_layout(const UnitConfig& unit) {
  UnitLayout layout;
  layout.unit = unit.unit;
  layout.sample_time_s = unit.sample_time_s;
  const auto add = [&](SignalKind kind, const std::string& tag, const std::string& measure) {
    layout[kind].tags.push_back(tag);
    layout[kind].engineering_units.push_back(measure);
  };
  for (const InputSignal& mv : unit.mv) add(SignalKind::kMv, mv.tag, mv.unit);
  for (const InputSignal& dv : unit.dv) add(SignalKind::kDv, dv.tag, dv.unit);
  for (const CvSignal& cv : unit.cv) {
    add(SignalKind::kCv, cv.tag, cv.unit);
    add(SignalKind::kPrediction, cv.prediction, cv.unit);
    add(SignalKind::kSetpoint, cv.setpoint, cv.unit);
  }
  for (const SignalKind kind : {SignalKind::kPrediction, SignalKind::kSetpoint}) {
    const std::vector<std::string>& tags = layout[kind].tags;
    if (std::all_of(tags.begin(), tags.end(), [](const std::string& tag) { return tag.empty(); }))
      layout[kind] = {};
  }
  return layout;
}

}  // namespace mpm::config
