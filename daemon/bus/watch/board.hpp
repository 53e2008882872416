#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/bus/watch/speakers.hpp"
#include "idl/output_readers.hpp"

namespace mpm::bus {

/// "u2" before "u10".
[[nodiscard]] bool natural_less(const std::string& a, const std::string& b);

/// One unit as the monitor sees it now.
struct UnitBoard {
  std::vector<std::string> inputs;  ///< columns: MVs, then DVs
  std::vector<std::string> cvs;     ///< rows
  std::map<std::pair<std::string, std::string>, ChannelRecord> channels;   ///< by (input, CV)
  std::map<std::pair<std::string, std::string>, AlarmStateRecord> alarms;  ///< the active ones
  std::map<std::string, std::vector<std::string>> layout;                  ///< by kind
  HealthRecord health;
  bool gone = false;  ///< its monitor left
  std::string note;   ///< what else there is to say of its monitors
  std::uint64_t samples = 0;
  std::int64_t last_interval = 0;
  double samples_per_s = 0.0;
  std::uint64_t samples_at_rate = 0;  // when the rate was last taken
};

/// Gathers outputs into what is worth showing. When the monitor of a unit starts anew, what the one
/// before it said goes.
class Board {
 public:
  /// `unit` empty: all.
  explicit Board(std::string unit) : unit_(std::move(unit)) {}

  using Clock = Speakers::Clock;

  /// False where `writer`, the process that this comes from, is not the monitor of its unit that is
  /// shown (Speakers). Asked before `update`.
  [[nodiscard]] bool listens_to(const idl::Output& output, const std::string& writer,
                                Clock::time_point now);
  /// `writer` empty: it is shown. What another one says is kept for when its turn comes.
  void update(const idl::Output& output, const std::string& writer = {});
  /// For when nobody speaks: what there is to say of a unit's monitors.
  void note_speakers(Clock::time_point now);
  /// Takes the sample rate over the time since the last call.
  void take_rate(std::chrono::duration<double> elapsed);

  [[nodiscard]] const std::map<std::string, UnitBoard>& units() const { return units_; }
  [[nodiscard]] bool any_alarm() const;
  [[nodiscard]] bool wanted(const std::string& unit) const {
    return unit_.empty() || unit == unit_;
  }

 private:
  UnitBoard* board_of(const std::string& unit);
  void turn_to(const std::string& unit, const std::string& before, const std::string& writer);
  void show(const idl::LayoutRecord& layout);
  void show(const ChannelRecord& channel);
  void show(const AlarmStateRecord& alarm);
  void show(const HealthRecord& health);
  void show(const idl::MonitorGone& gone);
  void show(const auto&) {}  // nothing else is on the board; an alarm's state follows its change

  std::string unit_;
  std::map<std::string, UnitBoard> units_;
  Speakers speakers_;
  std::map<std::pair<std::string, std::string>, UnitBoard> hidden_;  // by unit and writer
  std::string writer_;                                               // of what is being shown
};

}  // namespace mpm::bus
