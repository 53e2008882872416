#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mpm::bus {

/// What a trouble makes of a unit's health, as in NE 107; the worst last.
enum class Severity { kMaintenanceRequired, kFunctionCheck, kOutOfSpecification, kFailure };

/// The word of `mpm/health`.
[[nodiscard]] const char* to_string(Severity severity);

/// One reason why a unit is not watched as it should be.
struct Trouble {
  std::string key;  ///< what it is, while the numbers in `text` change
  Severity severity = Severity::kFailure;
  std::string text;        ///< for a person
  std::string event = {};  ///< which of its kind, where it happened at one moment; empty: it lasts
  /// Since when it has been so, where it can be told only after a while.
  std::optional<std::chrono::steady_clock::time_point> since = {};
  /// Of an event that left samples out: source time of the first one behind it.
  std::int64_t until_ns = 0;
};

/// Key of the trouble that nothing at all comes of a unit.
inline constexpr const char* kNoData = "no data";
/// What `mpm/health` says of a unit that has only begun.
inline constexpr const char* kNoCompleteData = "no complete data yet";
inline constexpr const char* kNothingDetermined = "nothing determined yet";
/// "2 alarms", "2 alarms, 1 silenced", "1 silenced alarm": of those that stand (`active`) so many
/// are `silenced`, and not to be annunciated by another name.
[[nodiscard]] std::string alarms_text(std::uint64_t active, std::uint64_t silenced);
/// The troubles in the detail of a health, without these and how many alarms there are, which are
/// none; empty if there are none.
[[nodiscard]] std::string troubles_in(const std::string& detail, std::uint32_t active_alarms,
                                      std::uint32_t silenced_alarms = 0);

/// Puts the worst first; those of one severity stay in their order.
void sort_by_severity(std::vector<Trouble>& troubles);
/// "first; second; third": at most `most` of them, and how many more there are.
[[nodiscard]] std::string joined_text(const std::vector<Trouble>& troubles, std::size_t most);

}  // namespace mpm::bus
