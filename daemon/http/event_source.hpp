#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace mpm::http {

/// Which alarm events are asked for; what is empty chooses nothing.
struct EventQuery {
  std::optional<std::int64_t> since_ns, until_ns;  ///< both included
  std::string unit, mv, cv;
  std::size_t most = 1000;
};

/// Where alarm events are kept.
class EventSource {
 public:
  EventSource() = default;
  EventSource(const EventSource&) = delete;
  EventSource& operator=(const EventSource&) = delete;
  virtual ~EventSource() = default;

  /// Records of alarms and diagnoses as report::json_of makes them, the youngest first. Called by
  /// any thread.
  [[nodiscard]] virtual std::vector<nlohmann::ordered_json> query(
      const EventQuery& query) const = 0;
};

}  // namespace mpm::http
