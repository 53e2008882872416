#pragma once

#include <algorithm>

#include "core/monitor/calibration.hpp"

namespace mpm {

/// How long a signal has kept one value: it stands still from
/// `calibration::input_motion::kStillSamples` repetitions on. Values that are not known are not
/// taken: they neither begin nor end a run.
class StillRun {
 public:
  /// Whether the value is the one before; false for the first.
  bool take(double value) {
    const bool same = begun_ && value == last_;
    run_ = same ? std::min(run_ + 1, calibration::input_motion::kStillSamples) : 0;
    last_ = value;
    begun_ = true;
    return same;
  }

  [[nodiscard]] bool stands() const { return run_ >= calibration::input_motion::kStillSamples; }

  template <class Archive>
  void archive(Archive& a) {
    a(run_, last_, begun_);
  }

 private:
  int run_ = 0;  // repetitions
  double last_ = 0.0;
  bool begun_ = false;
};

}  // namespace mpm
