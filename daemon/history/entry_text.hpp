#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/history/alarm_store.hpp"

/// An entry of the journal of alarms, for people and programs.
namespace mpm::history {

/// "2026-03-01 06:00:00 UTC  shell  u1 -> y1  acknowledged by ann: known (gain +41 %)"
[[nodiscard]] std::string entry_text(const AlarmEntry& entry);
[[nodiscard]] nlohmann::ordered_json entry_json(const AlarmEntry& entry);
/// RFC 4180, one line without its end. What a spreadsheet would take for a formula begins with an
/// apostrophe.
[[nodiscard]] std::string entry_csv(const AlarmEntry& entry);
[[nodiscard]] std::string entry_csv_head();

}  // namespace mpm::history
