#pragma once

#include <algorithm>
#include <cmath>

namespace mpm::sim::boiler {

/// A PI controller in the position form, with limits. Anti-windup: the integral stands where the
/// output is at a limit and the error pushes it further (Astrom and Hagglund 2006, ch. 3.5).
class Pi {
 public:
  struct Tuning {
    double gain;           ///< % of the actuator per unit
    double integral_time;  ///< s
  };
  Pi(const Tuning& tuning, double output) : tuning_(tuning), integral_(output) {}

  /// The actuator's %.
  double step(double setpoint, double measured, double seconds) {
    const double error = setpoint - measured;
    const double wanted = tuning_.gain * error + integral_;
    const bool further = (wanted > 100.0 && error * tuning_.gain > 0.0) ||
                         (wanted < 0.0 && error * tuning_.gain < 0.0);
    if (!further) integral_ += tuning_.gain * error * seconds / tuning_.integral_time;
    return std::clamp(wanted, 0.0, 100.0);
  }

 private:
  Tuning tuning_;
  double integral_;
};

/// A first-order lag, exact for an input that is held.
class Lag {
 public:
  Lag(double time_constant, double value) : time_constant_(time_constant), value_(value) {}
  double step(double input, double seconds) {
    value_ = input + (value_ - input) * std::exp(-seconds / time_constant_);
    return value_;
  }
  [[nodiscard]] double value() const { return value_; }

 private:
  double time_constant_, value_;
};

}  // namespace mpm::sim::boiler
