#include "daemon/report/unit_reading.hpp"

#include <utility>

#include "daemon/report/unit_monitor.hpp"

namespace mpm::report {

UnitReading::UnitReading(const config::UnitConfig& unit)
    : unit_(unit), model_(unit.model), reader_(fresh()), judged_(Screen::kHeld) {
  for (JudgedFrame& one : judged_) one.readings.resize(unit.cv.size());
}

UnitReader UnitReading::fresh() const {
  return {model_, unit_.counts(), predictions_of(unit_),
          derive_settings(unit_.model, model_, unit_.monitor, unit_.alarms)};
}

std::span<const JudgedFrame> UnitReading::push(const Frame& frame) {
  if (!first_ && frame.interval <= last_) return {};
  first_ = false;
  last_ = frame.interval;
  reader_.push(frame);
  if (reader_.anew()) {
    UnitReader anew = fresh();
    anew.begin_with(reader_.give_screen());
    reader_ = std::move(anew);
  }
  std::size_t count = 0;
  while (const Frame* read = reader_.next()) reader_.tell(*read, judged_[count++]);
  return std::span<const JudgedFrame>(judged_).first(count);
}

}  // namespace mpm::report
