#pragma once

#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::test {

/// mass y'' + damping y' + spring y + friction sign(y') = u behind a hold, sampled every second,
/// with true sticking where nothing overcomes the friction. Integrated in 500 steps a sample, apart
/// from any simulator of ours.
struct Servo {
  double mass = 270.0, damping = 9.0, spring = 1.0;
  double friction = 0.0;  ///< input units

  [[nodiscard]] Eigen::VectorXd respond(const Eigen::VectorXd& input) const {
    constexpr int kSteps = 500;
    double position = 0.0, speed = 0.0;
    Eigen::VectorXd result(input.size());
    for (Eigen::Index k = 0; k < input.size(); ++k) {
      result(k) = position;
      for (int step = 0; step < kSteps; ++step) {
        const double pull = input(k) - spring * position - damping * speed;
        if (speed == 0.0 && std::abs(pull) <= friction) break;  // stuck until the input moves
        const double before = speed;
        speed += (pull - std::copysign(friction, speed != 0.0 ? speed : pull)) / mass / kSteps;
        if (before * speed < 0.0) speed = 0.0;  // comes to rest on the way
        position += speed / kSteps;
      }
    }
    return result;
  }

  /// Without the friction: what a controller believes.
  [[nodiscard]] ChannelSpec model() const {
    if (spring == 0.0)
      return {0, 0, TransferFunction{1.0 / damping, {mass / damping}, 0.0, 0.0, true}, {}};
    // Underdamped, behind a hold (Astrom and Wittenmark 1997, table 2.1).
    const double decay = damping / (2.0 * mass);
    const double ringing = std::sqrt(spring / mass - decay * decay);
    const double left = std::exp(-decay), c = std::cos(ringing);
    const double s = decay / ringing * std::sin(ringing);
    return {
        0,
        0,
        DiscreteFilter{{(1.0 - left * (c + s)) / spring, (left * left + left * (s - c)) / spring},
                       {1.0, -2.0 * left * c, left * left},
                       0},
        {}};
  }
};

}  // namespace mpm::test
