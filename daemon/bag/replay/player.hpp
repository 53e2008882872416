#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "daemon/bag/replay/loop_shift.hpp"
#include "daemon/bag/replay/pacer.hpp"
#include "daemon/bag/replay/replay_source.hpp"
#include "daemon/host/clock.hpp"

namespace mpm::bag {

struct PlayerOptions {
  double rate = 1.0;                   ///< 0 = no waiting
  std::int64_t start_offset_ns = 0;    ///< recorded time to leave out at the beginning
  std::int64_t duration_ns = 0;        ///< recorded time to play; 0 = to the end
  std::int64_t end_offset_ns = 0;      ///< recorded time since the beginning to end at; 0 = none
  std::optional<std::int64_t> end_ns;  ///< log time to end at
  std::int64_t delay_ns = 0;           ///< to wait before the first sample, of every pass
  bool loop = false;                   ///< begin again at the end, for ever
  bool start_paused = false;
  std::string unit;                          ///< only this one; empty = all
  std::map<std::string, std::string> remap;  ///< unit names, from -> to
};

/// What a person at the keys wants.
enum class Key { kNone, kPause, kStep, kFaster, kSlower, kQuit };

/// How far the replay is.
struct PlayerState {
  std::uint64_t samples = 0;
  std::int64_t recorded_ns = 0;  ///< since the beginning of the recording, of this pass
  std::uint64_t passes = 0;      ///< complete ones
  double rate = 1.0;
  bool paused = false;
};

/// Sends the samples of a recording at their times. Everything outside comes in by the
/// constructor, so a test plays an hour in no time.
class Player {
 public:
  /// Returns false where it could not be written and the replay has to end.
  using Send = std::function<bool(const ReplaySample&, std::int64_t source_time_ns,
                                  const idl::SampleChange&)>;
  /// Asked before each sample and at least every 50 ms of waiting.
  using NextKey = std::function<Key(const PlayerState&)>;

  Player(ReplaySource& source, host::Clock& clock, const PlayerOptions& options, Send send,
         NextKey next_key);

  /// To the end, or until told to quit. False if `send` failed.
  [[nodiscard]] bool play();
  [[nodiscard]] const PlayerState& state() const { return state_; }

 private:
  enum class Wait { kSend, kQuit };

  [[nodiscard]] bool play_pass();
  void wait_for_start();
  [[nodiscard]] Wait wait_for(std::int64_t log_time_ns);
  /// True if a sample is to be sent now, whatever its time.
  [[nodiscard]] bool handle(Key key);

  ReplaySource& source_;
  host::Clock& clock_;
  PlayerOptions options_;
  Send send_;
  NextKey next_key_;
  PlayerState state_;
  LoopShift shift_;
  std::optional<Pacer> pacer_;
  std::optional<std::int64_t> begin_ns_;  // of the recording
  bool quit_ = false;
  bool sent_any_ = false;  // in this pass
};

}  // namespace mpm::bag
