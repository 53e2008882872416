#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/monitor/monitor.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/performance_record.hpp"
#include "daemon/files/times/time_choice.hpp"
#include "daemon/report/diagnosis/other_row.hpp"

namespace mpm::report {

/// Whether no channel is a mismatch, and some match.
[[nodiscard]] bool all_match(const std::vector<ChannelRecord>& channels);
/// CVs of which some channel mismatches or is in alarm.
[[nodiscard]] int mismatching_cvs(const std::vector<ChannelRecord>& channels);

/// What `mpm detect` found in a file: the verdicts after its last row and every alarm on the way.
struct DetectReport {
  std::string unit;
  std::uint64_t samples = 0;               ///< rows read
  std::uint64_t used_samples = 0;          ///< rows that entered the statistics
  std::int64_t first_ns = 0, last_ns = 0;  ///< their times
  std::uint64_t missing = 0;               ///< intervals without a row
  std::uint64_t out_of_order = 0;          ///< rows whose time did not grow
  std::uint64_t bad_values = 0;
  std::vector<std::pair<std::string, std::uint64_t>> bad_tags;  ///< whose they are
  std::uint64_t frozen = 0, clipped = 0, spikes = 0;            ///< of these: only by their look
  /// Of CVs whose predictions in the file are corrected by their measurement; not used.
  std::vector<std::string> corrected_predictions;
  /// Of CVs whose predictions are used and are not what the unit file's model gives.
  std::vector<std::string> other_predictions;
  std::map<std::string, double> read_every;  ///< samples, of CVs that are judged at their readings
  /// From the first row to the last of each stretch, where a part of the file was chosen.
  std::vector<files::Stretch> used;
  std::vector<ChannelRecord> channels;
  std::map<std::string, double> samples_needed;  ///< at least, by CV; 0 = none
  std::vector<AlarmRecord> alarms;
  PerformanceRecord performance;  ///< over all rows
  OtherRow other_row = OtherRow::kNone;

  [[nodiscard]] bool mismatch() const;
  /// What the monitor says of the unit's tags, beside its records.
  void take_counters(const Monitor& monitor, const config::UnitConfig& config);
};

/// The object of interfaces, "mpm detect".
[[nodiscard]] nlohmann::ordered_json to_json(const DetectReport& report);

}  // namespace mpm::report
