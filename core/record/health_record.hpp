#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/record/field_key.hpp"

namespace mpm {

/// How the monitor of one unit fares; topic mpm/health, whose fields these are.
struct HealthRecord {
  std::string unit;
  std::string state;   ///< NE 107 word
  std::string detail;  ///< why; if normal empty, or what is silenced
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::uint64_t frames = 0;
  std::uint64_t used = 0;
  std::uint64_t missing = 0;
  std::uint64_t incomplete = 0;
  std::uint64_t late = 0;
  std::uint64_t repeated = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t bad_values = 0;
  std::uint64_t wrong_length = 0;
  std::uint64_t unknown_unit = 0;
  std::uint64_t restarts = 0;
  std::uint32_t undetermined = 0;
  std::uint32_t matching = 0;
  std::uint32_t mismatching = 0;
  std::uint32_t active_alarms = 0;
  std::uint64_t beyond = 0;
  std::uint32_t silenced_alarms = 0;  ///< of the active ones

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("record", std::string_view("health"));
    visit("unit", record.unit, sample.unit...);
    visit("interval", record.interval, sample.interval...);
    visit("time_ns", record.source_time_ns, sample.source_time_ns...);
    visit("state", record.state, sample.state...);
    visit("detail", record.detail, sample.detail...);
    visit("frames", record.frames, sample.frames...);
    visit("used", record.used, sample.used...);
    visit("missing", record.missing, sample.missing...);
    visit("incomplete", record.incomplete, sample.incomplete...);
    visit("late", record.late, sample.late...);
    visit("repeated", record.repeated, sample.repeated...);
    visit("out_of_order", record.out_of_order, sample.out_of_order...);
    visit("bad_values", record.bad_values, sample.bad_values...);
    visit("wrong_length", record.wrong_length, sample.wrong_length...);
    visit("unknown_unit", record.unknown_unit, sample.unknown_unit...);
    visit("restarts", record.restarts, sample.restarts...);
    visit("undetermined", record.undetermined, sample.undetermined...);
    visit("matching", record.matching, sample.matching...);
    visit("mismatching", record.mismatching, sample.mismatching...);
    visit("active_alarms", record.active_alarms, sample.active_alarms...);
    visit("beyond", record.beyond, sample.beyond...);
    visit("silenced_alarms", record.silenced_alarms, sample.silenced_alarms...);
  }
};

}  // namespace mpm
