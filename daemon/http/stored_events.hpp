#pragma once

#include <string>
#include <utility>

#include "daemon/http/event_source.hpp"

namespace mpm::http {

/// The journal of alarms that mpmd keeps (history::AlarmStore): all that happened to alarms and
/// what people did about them, before this start, too.
class StoredEvents : public EventSource {
 public:
  explicit StoredEvents(std::string path) : path_(std::move(path)) {}

  /// By when they were written. Nothing while the file cannot be read: health says so.
  [[nodiscard]] std::vector<nlohmann::ordered_json> query(const EventQuery& query) const override;

 private:
  std::string path_;
};

}  // namespace mpm::http
