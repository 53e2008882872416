#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/bus/output_readers.hpp"

namespace mpm::bus {

/// "u2" before "u10".
[[nodiscard]] bool natural_less(const std::string& a, const std::string& b);

/// One unit as the monitor sees it now.
struct UnitBoard {
  std::vector<std::string> inputs;  ///< columns: MVs, then DVs
  std::vector<std::string> cvs;     ///< rows
  std::map<std::pair<std::string, std::string>, report::ChannelRecord>
      channels;                                                               ///< by (input, CV)
  std::map<std::pair<std::string, std::string>, report::AlarmRecord> alarms;  ///< the active ones
  std::map<std::string, std::vector<std::string>> layout;                     ///< by kind
  report::HealthRecord health;
  bool gone = false;  ///< its monitor left
  std::uint64_t samples = 0;
  std::int64_t last_interval = 0;
  double samples_per_s = 0.0;
  std::uint64_t samples_at_rate = 0;  // when the rate was last taken
};

/// Gathers outputs into what is worth showing.
class Board {
 public:
  /// `unit` empty: all.
  explicit Board(std::string unit) : unit_(std::move(unit)) {}

  void update(const Output& output);
  /// Takes the sample rate over the time since the last call.
  void take_rate(std::chrono::duration<double> elapsed);

  [[nodiscard]] const std::map<std::string, UnitBoard>& units() const { return units_; }
  [[nodiscard]] bool any_alarm() const;
  [[nodiscard]] bool wanted(const std::string& unit) const {
    return unit_.empty() || unit == unit_;
  }

 private:
  UnitBoard* board_of(const std::string& unit);
  void show(const LayoutRecord& layout);
  void show(const report::ChannelRecord& channel);
  void show(const AlarmStateRecord& state);
  void show(const report::AlarmRecord& change);
  void show(const report::HealthRecord& health);
  void show(const MonitorGone& gone);

  std::string unit_;
  std::map<std::string, UnitBoard> units_;
};

}  // namespace mpm::bus
