#include "daemon/live/live_diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"

namespace mpm::live {
namespace {

constexpr std::chrono::minutes kBetweenTries{1};  // of writing

ScheduleSettings schedule_of(const config::UnitConfig& unit) {
  ScheduleSettings settings;
  settings.needed_rows = static_cast<int>(needed_samples(unit.model));
  settings.renewed_rows = std::max(1, unit.monitor.diagnosis_samples / 2);
  settings.settling_rows = std::min(settings.settling_rows, settings.renewed_rows);
  settings.period_ns = std::llround(unit.monitor.diagnosis_period_s * 1e9);
  return settings;
}

std::size_t index_of(const std::vector<std::string>& tags, const std::string& tag) {
  return static_cast<std::size_t>(std::find(tags.begin(), tags.end(), tag) - tags.begin());
}

}  // namespace

LiveDiagnosis::LiveDiagnosis(std::shared_ptr<const config::UnitConfig> unit,
                             DiagnosisWorker& worker, int asker)
    : unit_(std::move(unit)),
      worker_(worker),
      asker_(asker),
      ring_(unit_->counts(), unit_->monitor.diagnosis_samples),
      schedule_(schedule_of(*unit_)) {}

void LiveDiagnosis::note(const AlarmRecord& change) {
  if (change.to != AlarmChange::kActive) {
    alarms_.erase({change.mv, change.cv});
    return;
  }
  const std::vector<std::string> cvs = unit_->cv_tags();
  alarms_[{change.mv, change.cv}] = {
      change, index_of(unit_->input_tags(), change.mv) * cvs.size() + index_of(cvs, change.cv)};
  youngest_alarm_ns_ = change.source_time_ns;
}

void LiveDiagnosis::push(const Frame& frame, const std::vector<AlarmRecord>& changes) {
  ring_.push(frame);
  bool raised = false;
  for (const AlarmRecord& change : changes) {
    note(change);
    raised = raised || change.to == AlarmChange::kActive;
  }
  if (!schedule_.due(frame.source_time_ns, ring_.rows(), raised, !alarms_.empty())) return;
  ask();
}

void LiveDiagnosis::ask() {
  pending_.emplace();
  pending_->asker = asker_;
  pending_->unit = unit_;
  pending_->samples = ring_.copy();
  pending_->unseen_rows = unseen_rows(ring_.rows(), schedule_.rows_since_alarm());
  pending_->alarm_time_ns = youngest_alarm_ns_;
}

void LiveDiagnosis::archive(Archive& a) {
  // not archived: unit_, worker_, asker_ (construction)
  // not archived: alarms_, youngest_alarm_ns_ (`resume`)
  // not archived: pending_, file_problem_, unwritten_, unwritten_alarm_ns_, next_try_ (of a
  // process)
  a(ring_, schedule_);
}

void LiveDiagnosis::resume(const std::vector<AlarmStateRecord>& alarms) {
  std::int64_t youngest = 0;
  for (const AlarmStateRecord& alarm : alarms) {
    note(alarm);
    if (alarm.to == AlarmChange::kActive) youngest = std::max(youngest, alarm.source_time_ns);
  }
  youngest_alarm_ns_ = youngest;
}

void LiveDiagnosis::repeat() {
  if (!pending_ && schedule_.started() && !alarms_.empty()) ask();
}

void LiveDiagnosis::write_again(Clock::time_point now) {
  if (file_problem_.empty() || pending_ || now < next_try_) return;
  DiagnosisJob job;
  job.asker = asker_;
  job.only_writes = true;
  job.unwritten = unwritten_;
  job.alarm_time_ns = unwritten_alarm_ns_;
  if (worker_.submit(job)) next_try_ = now + kBetweenTries;
}

std::optional<DiagnosisOutcome> LiveDiagnosis::poll(Clock::time_point now) {
  if (pending_ && worker_.submit(*pending_)) pending_.reset();
  write_again(now);
  std::optional<DiagnosisOutcome> outcome = worker_.take(asker_);
  if (!outcome || !outcome->problem.empty()) return outcome;
  if (file_problem_.empty()) next_try_ = now + kBetweenTries;
  file_problem_ = outcome->file_problem;
  if (file_problem_.empty()) unwritten_.reset();
  if (outcome->unwritten != nullptr) {
    unwritten_ = std::move(outcome->unwritten);
    unwritten_alarm_ns_ = outcome->alarm_time_ns;
  }
  return outcome;
}

std::vector<AlarmRecord> LiveDiagnosis::diagnosed(const DiagnosisOutcome& outcome) const {
  std::vector<AlarmRecord> records;
  for (const auto& [tags, standing] : alarms_) {
    if (standing.alarm.interval > outcome.interval || standing.channel >= outcome.causes.size())
      continue;
    records.push_back(standing.alarm);
    records.back().to = AlarmChange::kDiagnosed;
    records.back().named = outcome.causes[standing.channel];
  }
  return records;
}

}  // namespace mpm::live
