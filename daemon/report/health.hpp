#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace mpm::report {

/// How the monitor of one unit fares; topic mpm/health, whose fields these are.
struct HealthRecord {
  std::string unit;
  std::string state;   ///< NE 107 word
  std::string detail;  ///< why; empty if normal
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
};

[[nodiscard]] nlohmann::ordered_json to_json(const HealthRecord& record);

}  // namespace mpm::report
