#include "daemon/http/unit_feed.hpp"

#include <limits>
#include <utility>

namespace mpm::http {
namespace {

float value_of(const SignalBlock& block, int index) {
  if (index >= block.size() || !block.usable(index)) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(block.values(index));
}

/// Some channel of the CV matches, none mismatches, and nothing is being looked for.
bool is_known_to_match(const Monitor& monitor, int cv, int inputs) {
  bool some = false;
  for (int i = 0; i < inputs; ++i) {
    const ChannelStatus& channel = monitor.channel(cv, i);
    if (channel.verdict == Verdict::kMismatch || channel.reason == Reason::kWarmingUp ||
        channel.reason == Reason::kIsolating)
      return false;
    some = some || channel.verdict == Verdict::kMatch;
  }
  return some;
}

}  // namespace

void Delivery::clear() {
  rows.clear();
  values.clear();
  judged.clear();
  readings.clear();
  digests.clear();
  alarms.clear();
  diagnosis.reset();
  view.reset();
  dropped = 0;
}

UnitFeed::UnitFeed(const config::UnitConfig& unit)
    : columns_{unit.counts().cv, unit.counts().inputs()}, counts_(unit.counts()), digests_(unit) {}

void UnitFeed::on_frame(const Frame& frame, const report::UnitMonitor& monitor) {
  news_ = true;
  note_digest(monitor);
  if (noted_.rows.size() >= kMostRows) {
    ++noted_.dropped;
    return;
  }
  note_frame(frame);
  note_readings(monitor.monitor());
  noted_.rows.back().judged = noted_.judged.size();
  offer();
}

void UnitFeed::on_recalled(const Frame& frame, const report::UnitMonitor* monitor) {
  note_frame(frame);
  if (monitor != nullptr) {
    note_digest(*monitor);
    note_readings(monitor->monitor());
  }
  noted_.rows.back().judged = noted_.judged.size();
  offer();
}

void UnitFeed::note_digest(const report::UnitMonitor& monitor) {
  std::optional<history::Digest> digest = digests_.push(monitor);
  if (digest) noted_.digests.push_back(std::move(*digest));
}

void UnitFeed::note_frame(const Frame& frame) {
  noted_.rows.push_back({frame.interval, frame.source_time_ns, 0});
  for (int j = 0; j < columns_.cvs; ++j) {
    noted_.values.push_back(value_of(frame[SignalKind::kCv], j));
    noted_.values.push_back(value_of(frame[SignalKind::kPrediction], j));
    noted_.values.push_back(value_of(frame[SignalKind::kSetpoint], j));
  }
  for (int i = 0; i < counts_.mv; ++i) noted_.values.push_back(value_of(frame[SignalKind::kMv], i));
  for (int i = 0; i < counts_.dv; ++i) noted_.values.push_back(value_of(frame[SignalKind::kDv], i));
}

void UnitFeed::note_readings(const Monitor& monitor) {
  for (const JudgedFrame& judged : monitor.judged()) {
    noted_.judged.push_back(judged.interval);
    for (int j = 0; j < columns_.cvs; ++j) {
      const CvReading& reading = judged.readings[static_cast<std::size_t>(j)];
      noted_.readings.push_back(static_cast<float>(reading.measured - reading.residual));
      noted_.readings.push_back(static_cast<float>(reading.residual));
      noted_.readings.push_back(is_known_to_match(monitor, j, columns_.inputs) ? 1.0F : 0.0F);
    }
  }
}

void UnitFeed::on_alarm(const AlarmRecord& alarm, const std::string& text) {
  news_ = true;
  noted_.alarms.emplace_back(alarm, text);
}

void UnitFeed::on_diagnosis(const live::DiagnosisOutcome& outcome) {
  news_ = true;
  noted_.diagnosis = outcome;
  noted_.diagnosis->unwritten.reset();  // a report in memory is nobody's here
}

bool UnitFeed::wants_view(Clock::time_point now) {
  offer();
  if (now - last_view_ < (news_ ? kViewPeriod : kIdlePeriod)) return false;
  last_view_ = now;
  news_ = false;
  return true;
}

void UnitFeed::on_view(const live::UnitView& view) {
  auto copy = std::make_shared<UnitSnapshot>();
  copy->channels = view.channels;
  copy->alarms = view.alarms;
  copy->controller = view.controller;
  copy->health = view.health;
  copy->troubles = view.troubles;
  copy->performance = view.performance;
  copy->speaks = view.speaks;
  noted_.view = std::move(copy);
  offer();
}

void UnitFeed::offer() {
  if (!mutex_.try_lock()) return;
  const MutexLock lock(mutex_, std::adopt_lock);
  if (!fetched_) return;
  std::swap(noted_, offered_);  // which is empty
  fetched_ = false;
}

void UnitFeed::fetch(Delivery& emptied) {
  const MutexLock lock(mutex_);
  if (fetched_) return;
  std::swap(offered_, emptied);
  fetched_ = true;
}

}  // namespace mpm::http
