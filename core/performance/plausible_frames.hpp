#pragma once

#include <cstdint>

#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

/// A unit's frames without the values that no process gives: those far beyond all that a signal has
/// been, which came back as abruptly (`Screen`). A value that only looks odd (frozen, a spike)
/// stays: controllers act on it, and it is in the historian too. A frame waits for nothing but the
/// end of an excursion. No allocation after construction.
class PlausibleFrames {
 public:
  explicit PlausibleFrames(const SignalCounts& counts) : screen_(counts, Screen::Looks::kFar) {}

  /// Takes a frame that is newer than all before in its run; of others it says false.
  bool push(const Frame& frame) {
    if (begun_ && frame.interval <= interval_) return false;
    begun_ = true;
    interval_ = frame.interval;
    screen_.push(frame);
    return true;
  }
  /// With the last frame it turned out that sums over all that has left are worth nothing: wild
  /// values are in them, or a signal lives elsewhere from now on.
  [[nodiscard]] bool anew() const { return screen_.anew(); }
  /// The next frame that leaves; null where there is none. Valid until the next call.
  [[nodiscard]] const Frame* next() { return screen_.next(); }
  /// What follows is another run: what waits is to leave.
  void end_run() {
    screen_.end_run();
    begun_ = false;
  }

  template <class Archive>
  void archive(Archive& a) {
    a(screen_, interval_, begun_);
  }

 private:
  Screen screen_;
  std::int64_t interval_ = 0;  // of the last frame
  bool begun_ = false;
};

}  // namespace mpm
