#include "daemon/http/stored_events.hpp"

#include <exception>

#include "daemon/history/alarm_store.hpp"

namespace mpm::http {
namespace {

using Json = nlohmann::ordered_json;

// With the names of mpm/alarm, as far as they are the same.
Json event_json(const history::AlarmEntry& entry) {
  return {{"record", entry.what == "diagnosed" ? "diagnosis" : "alarm"},
          {"unit", entry.unit},
          {"time_ns", entry.written_ns},
          {"mv", entry.mv},
          {"cv", entry.cv},
          {"to", entry.what},
          {"text", entry.message},
          {"alarm_state", to_string(entry.standing.word())},
          {"suppressed", entry.standing.suppressed},
          {"suppressed_by_design", entry.standing.suppressed_by_design},
          {"notification_class", to_string(entry.notification_class)},
          {"priority", to_string(entry.priority)},
          {"client_user_id", entry.user},
          {"host", entry.host},
          {"comment", entry.comment}};
}

}  // namespace

std::vector<Json> StoredEvents::query(const EventQuery& query) const {
  history::AlarmQuery wanted;
  wanted.since_ns = query.since_ns;
  if (query.until_ns) wanted.until_ns = *query.until_ns + 1;  // it is included here
  wanted.unit = query.unit;
  wanted.mv = query.mv;
  wanted.cv = query.cv;
  std::vector<Json> events;
  try {
    const history::AlarmStore store(path_, history::AlarmStore::Access::kRead);
    for (const history::AlarmEntry& entry : store.youngest(wanted, query.most))
      events.push_back(event_json(entry));
  } catch (const std::exception&) {
    events.clear();
  }
  return events;
}

}  // namespace mpm::http
