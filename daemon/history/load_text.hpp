#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/alarm/alarm_load.hpp"
#include "daemon/history/alarm_store.hpp"

/// How much the alarms in a journal asked of people.
namespace mpm::history {

/// Who is asked: operators by controllers' alarms of class alarm, engineers by all else.
struct LoadReport {
  struct Part {
    std::vector<std::string> names;  ///< "shell", "shell: u1 -> y1"; as in load.by_alarm
    AlarmLoad load;
  };
  Part operators, engineers;
  std::int64_t from_ns = 0, until_ns = 0;
};

/// Without times in `query`: from the first entry to the last.
[[nodiscard]] LoadReport load_report(const AlarmStore& store, const AlarmQuery& query);
[[nodiscard]] std::string load_text(const LoadReport& report);
[[nodiscard]] nlohmann::ordered_json load_json(const LoadReport& report);

}  // namespace mpm::history
