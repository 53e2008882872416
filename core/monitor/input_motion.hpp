#pragma once

#include <algorithm>

#include "core/monitor/calibration.hpp"
#include "core/monitor/still_run.hpp"

namespace mpm {

/// How one input has moved lately: the share of samples at which it had stood still for long, and
/// the share at which it rested at the end of its range. Exponentially weighted.
class InputMotion {
 public:
  /// `memory_samples` > 0.
  explicit InputMotion(double memory_samples) : step_(1.0 / memory_samples) {}

  void take(double value) {
    if (samples_ == 0) {
      low_ = high_ = value;
      run_.take(value);
    } else {
      const bool same = run_.take(value);
      const double range = high_ - low_;
      const double reach = calibration::input_motion::kAtEnd * range;
      const bool at_end = same && range > 0.0 && (value <= low_ + reach || value >= high_ - reach);
      const double step = std::max(step_, 1.0 / (samples_ + 1.0));
      still_ += step * ((run_.stands() ? 1.0 : 0.0) - still_);
      at_end_ += step * ((at_end ? 1.0 : 0.0) - at_end_);
      low_ = std::min(low_, value);
      high_ = std::max(high_, value);
    }
    ++samples_;
  }

  [[nodiscard]] bool still() const { return still_ > calibration::input_motion::kMostOfTheTime; }
  [[nodiscard]] bool at_limit() const {
    return at_end_ > calibration::input_motion::kMostOfTheTime;
  }

  template <class Archive>
  void archive(Archive& a) {
    // not archived: step_ (construction)
    a(samples_, run_, still_, at_end_, low_, high_);
  }

 private:
  double step_;
  double samples_ = 0.0;
  StillRun run_;
  double still_ = 0.0, at_end_ = 0.0;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace mpm
