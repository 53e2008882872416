#pragma once

#include <chrono>
#include <string>

#include "daemon/bus/watch/board.hpp"
#include "daemon/bus/watch/render.hpp"

namespace mpm::bus {

enum class ViewMode {
  kTable,  ///< redrawn in place, for a terminal
  kLines,  ///< one line per change
  kJson,   ///< one JSON line per record
};

/// Shows outputs on stdout.
class Viewer {
 public:
  using Clock = std::chrono::steady_clock;

  Viewer(ViewMode mode, const RenderOptions& options, std::string unit);

  /// `writer`: the process it comes from. Of several monitors of one unit one is shown (Speakers);
  /// as JSON everything is.
  void show(const idl::Output& output, const std::string& writer, Clock::time_point now);
  /// Redraws the table a few times a second; passes on what was written so far.
  void tick(Clock::time_point now);
  /// False when nobody reads stdout any more.
  [[nodiscard]] bool has_reader() const;
  [[nodiscard]] bool any_alarm() const { return board_.any_alarm(); }

 private:
  void print_json(const idl::Output& output);
  void print_change(const idl::Output& output);
  void draw(Clock::time_point now);

  ViewMode mode_;
  RenderOptions options_;
  Board board_;
  Clock::time_point last_drawn_{};
  Clock::time_point last_rate_;
};

}  // namespace mpm::bus
