#pragma once

#include <string>

#include "daemon/bus/watch/board.hpp"

namespace mpm::bus {

struct RenderOptions {
  bool color = true;
  bool alarms_only = false;
};

/// The board as text for a terminal, one line per line: per unit its health, the matrix of verdicts
/// (a row per CV, a column per input) and the active alarms. Colour only repeats what words say.
[[nodiscard]] std::string render(const Board& board, const RenderOptions& options);

/// What a log should say if `before` became `after`; empty if nothing that matters changed.
/// `before` may be null.
[[nodiscard]] std::string change_line(const report::ChannelRecord* before,
                                      const report::ChannelRecord& after);
[[nodiscard]] std::string change_line(const report::AlarmRecord& change);
[[nodiscard]] std::string change_line(const report::HealthRecord& before,
                                      const report::HealthRecord& after);

}  // namespace mpm::bus
