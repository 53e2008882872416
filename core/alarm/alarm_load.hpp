#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/alarm/alarm_settings.hpp"

namespace mpm {

/// Something that an alarm did and that counts for how much alarms ask of people.
struct AlarmLoadEvent {
  enum class Kind : unsigned char {
    kAnnunciated,  ///< it called for attention
    kEnded,        ///< nothing stands any more, or nobody need look
  };
  std::int64_t time_ns = 0;
  int alarm = 0;  ///< which, 0 ...
  Kind kind = Kind::kAnnunciated;
  AlarmPriority priority = AlarmPriority::kLow;
};

/// How much alarms ask of who answers them, by the measures of ISA-18.2 and EEMUA 191.
struct AlarmLoad {
  double days = 0.0;
  std::uint64_t annunciated = 0;
  double per_day = 0.0;
  std::uint64_t most_in_10_min = 0;
  std::uint64_t floods = 0;                    ///< begin above 10 in 10 min, end below 5
  double time_in_flood = 0.0;                  ///< share, 0..1
  std::uint64_t chattering = 0;                ///< alarms that came three times within a minute
  std::uint64_t stale = 0;                     ///< alarms that stood for more than 24 h at a time
  std::array<std::uint64_t, 3> by_priority{};  ///< low, medium, high
  std::vector<std::uint64_t> by_alarm;         ///< annunciations of each
};

/// `events`: in the order of time, of alarms 0 .. `alarms` - 1, between `from_ns` and `until_ns`.
[[nodiscard]] AlarmLoad alarm_load(const std::vector<AlarmLoadEvent>& events, int alarms,
                                   std::int64_t from_ns, std::int64_t until_ns);

}  // namespace mpm
