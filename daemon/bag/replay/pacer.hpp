#pragma once

#include <cstdint>

namespace mpm::bag {

/// When what was recorded at some time is due now. Holds one pair of equal moments, recorded and
/// now, and takes a new one whenever the rate changes or the replay pauses or goes on, so that
/// nothing jumps. Times in ns; knows no clock.
class Pacer {
 public:
  /// What was recorded at `recorded` is due at `now`. `rate`: recorded time per time; 0 = no
  /// waiting.
  Pacer(double rate, std::int64_t recorded, std::int64_t now)
      : rate_(rate), recorded_(recorded), now_(now) {}

  /// Meaningless while paused.
  [[nodiscard]] std::int64_t due(std::int64_t recorded) const;

  void set_rate(double rate, std::int64_t now);
  void pause(std::int64_t now);
  void resume(std::int64_t now);
  /// While paused: the recorded time moves on to that of a sample that was sent by hand.
  void skip_to(std::int64_t recorded);

  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] bool paused() const { return paused_; }

 private:
  /// Makes `now` the new moment of reference.
  void take_reference(std::int64_t now);

  double rate_;
  std::int64_t recorded_, now_;
  bool paused_ = false;
};

}  // namespace mpm::bag
