#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identify/evidence/unanswered_pulses.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/files/times/time_zone.hpp"

namespace mpm::report {

/// "no CV answers u1 going from 40.1 to 95 and back at 00:59:00 on 6 January: it is taken as not
/// known there"; empty where there is none. `zone`: null = UTC.
[[nodiscard]] std::string pulses_text(const config::UnitConfig& unit, const Recording& recording,
                                      const std::vector<Pulse>& pulses,
                                      const files::TimeZone* zone);

}  // namespace mpm::report
