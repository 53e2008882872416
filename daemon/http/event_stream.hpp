#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "daemon/http/board.hpp"

namespace mpm::http {

/// What one reader of /api/v1/events is told, as server-sent events: `state` with the id of each
/// unit's snapshot, at once and whenever one changes, and `alive` where nothing has for long, so
/// that a reader knows silence from loss. An id is of this run of the monitor: who comes back with
/// one of another run is told all.
class EventStream {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kLeastBetween{500}, kMostBetween{3000};

  /// `run`: tells this run of the monitor from others. `last_id`: of the header Last-Event-ID;
  /// empty where there is none.
  EventStream(const Board& board, std::string run, const std::string& last_id);

  /// Waits for something to tell, a second at most; empty where there was nothing. Sets `ended`
  /// when the board closes.
  [[nodiscard]] std::string next(bool& ended);

 private:
  [[nodiscard]] std::string state() const;

  const Board& board_;
  std::string run_;
  std::uint64_t told_ = 0;  // version
  bool begun_ = false, knows_ = false;
  Clock::time_point last_{};
};

}  // namespace mpm::http
