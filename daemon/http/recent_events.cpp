#include "daemon/http/recent_events.hpp"

#include <utility>

#include "daemon/report/record_json.hpp"

namespace mpm::http {

void RecentEvents::add(const AlarmRecord& alarm, std::string text) {
  auto event = std::make_shared<const Event>(Event{alarm, std::move(text)});
  const MutexLock lock(mutex_);
  events_.push_back(std::move(event));
  if (events_.size() > kept_) events_.pop_front();
}

std::vector<nlohmann::ordered_json> RecentEvents::query(const EventQuery& query) const {
  std::vector<std::shared_ptr<const Event>> chosen;
  {
    const MutexLock lock(mutex_);
    for (auto event = events_.rbegin(); event != events_.rend() && chosen.size() < query.most;
         ++event) {
      const AlarmRecord& record = (*event)->alarm;
      if ((query.since_ns && record.source_time_ns < *query.since_ns) ||
          (query.until_ns && record.source_time_ns > *query.until_ns) ||
          (!query.unit.empty() && record.unit != query.unit) ||
          (!query.mv.empty() && record.mv != query.mv) ||
          (!query.cv.empty() && record.cv != query.cv))
        continue;
      chosen.push_back(*event);
    }
  }
  std::vector<nlohmann::ordered_json> events;
  events.reserve(chosen.size());
  for (const auto& event : chosen) {
    events.push_back(report::json_of(event->alarm));
    events.back()["text"] = event->text;
  }
  return events;
}

}  // namespace mpm::http
