#pragma once

#include <string>

#include "daemon/bus/watch/board.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::bus {

struct RenderOptions {
  report::Layout layout;
  bool alarms_only = false;
};

/// The board as text for a terminal, one line per line: per unit its health, the matrix of verdicts
/// (a row per CV, a column per input) and the active alarms.
[[nodiscard]] std::string render(const Board& board, const RenderOptions& options);

/// What a log should say if `before` became `after`; empty if nothing that matters changed.
/// `before` may be null.
[[nodiscard]] std::string change_line(const ChannelRecord* before, const ChannelRecord& after);
/// `channel`: that of the alarm; null = not known.
[[nodiscard]] std::string change_line(const AlarmRecord& change, const ChannelRecord* channel);
[[nodiscard]] std::string change_line(const HealthRecord& before, const HealthRecord& after);

}  // namespace mpm::bus
