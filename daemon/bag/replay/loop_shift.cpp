#include "daemon/bag/replay/loop_shift.hpp"

#include <algorithm>

#include "idl/topic_catalog.hpp"

namespace mpm::bag {

void LoopShift::Span::add(std::int64_t value) {
  first = seen ? std::min(first, value) : value;
  last = seen ? std::max(last, value) : value;
  seen = true;
}

void LoopShift::see(const ReplaySample& sample, const std::string& unit) {
  if (sample.state != idl::InstanceState::kAlive) return;
  written_ns_.add(sample.source_time_ns);
  const idl::KnownTopic* topic = idl::find_known_topic(sample.topic);
  if (topic == nullptr || !topic->input) return;
  const std::optional<idl::SampleStamp> stamp = idl::stamp_of(sample.cdr);
  if (!stamp) return;
  units_[unit].intervals.add(stamp->interval);
  units_[unit].times_ns.add(stamp->source_time_ns);
}

void LoopShift::next_pass() {
  for (auto& [name, unit] : units_) {
    const std::int64_t length = unit.intervals.length();
    const std::int64_t length_ns = unit.times_ns.length();
    const std::int64_t step_ns = length > 0 ? length_ns / length : 0;
    unit.add_intervals = saturated_sum(unit.add_intervals, saturated_sum(length, 2));
    unit.add_time_ns = saturated_sum(unit.add_time_ns, length_ns);
    for (int step = 0; step < 2; ++step)
      unit.add_time_ns = saturated_sum(unit.add_time_ns, step_ns);
  }
  time_shift_ns_ = saturated_sum(time_shift_ns_, saturated_sum(written_ns_.length(), 1));
}

idl::SampleChange LoopShift::change_of(const std::string& unit) const {
  const auto found = units_.find(unit);
  if (found == units_.end()) return {};
  return {"", found->second.add_intervals, found->second.add_time_ns};
}

}  // namespace mpm::bag
