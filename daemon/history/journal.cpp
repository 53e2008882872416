#include "daemon/history/journal.hpp"

#include <utility>

#include "daemon/history/digest_json.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::history {

Journal::Journal(const config::UnitConfig& unit, JournalFiles files)
    : unit_(unit.unit),
      inputs_(unit.counts().inputs()),
      cvs_(unit.counts().cv),
      files_(std::move(files)),
      digests_(unit) {}

std::vector<Journal::Said> Journal::said_by(const Monitor& monitor) const {
  std::vector<Said> said;
  for (int i = 0; i < inputs_; ++i) {
    for (int j = 0; j < cvs_; ++j) {
      const ChannelStatus& status = monitor.channel(j, i);
      said.push_back({status.verdict, status.reason, status.confounder, monitor.alarm(j, i)});
    }
  }
  return said;
}

void Journal::push(report::UnitMonitor& monitor) {
  files_.turn_over();
  if (files_.empty()) {
    add(line_of(digests_.head(monitor.source_time_ns())));
    said_.clear();
  }
  if (const std::optional<Digest> digest = digests_.push(monitor)) add(line_of(unit_, *digest));
  add_changes(monitor);
  for (const AlarmRecord& alarm : monitor.alarms()) add(report::json_text(report::json_of(alarm)));
  write();
}

// The correlations are most of a record, and say nothing of a change.
void Journal::add_changes(report::UnitMonitor& monitor) {
  std::vector<Said> said = said_by(monitor.monitor());
  if (said == said_) return;
  for (std::size_t c = 0; c < said.size(); ++c) {
    if (!said_.empty() && said[c] == said_[c]) continue;
    nlohmann::ordered_json record = report::json_of(monitor.channels()[c]);
    record.erase("partial_correlations");
    add(report::json_text(record));
  }
  said_ = std::move(said);
}

// Before the first sample there is no head, and nothing that a state could be the state of.
void Journal::push(const HealthRecord& health) {
  if (health.state == health_ || files_.empty()) return;
  add(report::json_text(report::json_of(health)));
  health_ = health.state;
  write();
}

void Journal::finish() {
  if (const std::optional<Digest> digest = digests_.finish()) add(line_of(unit_, *digest));
  write();
}

void Journal::write() {
  if (!lines_.empty() && !files_.append(lines_)) {
    said_.clear();
    health_.clear();
  }
  lines_.clear();
}

}  // namespace mpm::history
