#pragma once

#include <Eigen/Core>

namespace mpm {

/// What the shapes of a loop's swing say of its valve, without any model. None of the tests is good
/// alone: a valve is named only where at least two agree and the loop swings regularly.
struct ValveShape {
  enum class Verdict {
    kSticks,
    kSound,      ///< it swings regularly, and no test finds sticking: it may be too slight for them
    kUndecided,  ///< it swings regularly, and the tests do not agree, or one has nothing to say
    kNoSwing,    ///< it does not swing regularly, or not often enough: there is nothing to judge
    kFollows,    ///< it swings with its set-point, whose cause is elsewhere
  };
  Verdict verdict = Verdict::kNoSwing;
  double period_s = 0.0;    ///< 0 = none
  double regularity = 0.0;  ///< the less regular one of both signals (oscillation.hpp)
  int half_cycles = 0;      ///< of the process value
  // Evidence (shapes.hpp); NaN where there is none.
  double triangle = 0.0;  ///< of the controller's output or the process value, the larger
  double relay = 0.0;     ///< of the process value
  double resting = 0.0;   ///< of both
  // Which tests agree, by the limits of their authors.
  bool triangle_sticks = false;
  bool relay_sticks = false;
  bool resting_sticks = false;

  [[nodiscard]] int agreeing() const {
    return int{triangle_sticks} + int{relay_sticks} + int{resting_sticks};
  }
};

/// From a controller's output, its process value and its set-point, samples each and in any unit,
/// of a loop in automatic at steady conditions: unknown values (NaN) count as the last known one.
[[nodiscard]] ValveShape judge_valve(const Eigen::Ref<const Eigen::VectorXd>& output,
                                     const Eigen::Ref<const Eigen::VectorXd>& value,
                                     const Eigen::Ref<const Eigen::VectorXd>& setpoint,
                                     double sample_time_s);

}  // namespace mpm
