#pragma once

#include <cstdint>
#include <string>

#include "daemon/bag/replay/player.hpp"
#include "daemon/bag/replay/replay_source.hpp"

namespace mpm::bag {

/// True where nothing that was received at `log_time_ns` or later is to be replayed, of a recording
/// whose first sample came at `begin_ns`.
[[nodiscard]] bool is_over(const PlayerOptions& options, std::int64_t begin_ns,
                           std::int64_t log_time_ns);
/// True where a sample of `unit` of that time is to be replayed.
[[nodiscard]] bool selects(const PlayerOptions& options, std::int64_t begin_ns,
                           std::int64_t log_time_ns, const std::string& unit);

/// Throws std::invalid_argument where the options choose no sample of `source`, or rename a unit
/// that it does not hold. Reads no more than that takes and leaves `source` at its first sample.
void check_selection(ReplaySource& source, const PlayerOptions& options);

}  // namespace mpm::bag
