#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "core/identification/identification.hpp"
#include "tests/core/identify/small_plant.hpp"

/// A small plant in a loop, in closed form: what tests/oracles/identification.py simulates too.
namespace mpm::test {

struct LagChannel {
  double gain, time_constant;
  Eigen::Index dead;
};

/// Two inputs, one CV. The first input follows a set-point: gain (setpoint - CV); the second moves
/// from outside. Noise e / (1 - 0.8 q^-1).
struct Loop {
  LagChannel first{2.0, 15.0, 3}, second{-1.0, 6.0, 1};
  double controller = 0.4, noise = 0.1;
  std::uint64_t seed = 0;
  bool setpoint_moves = true;

  [[nodiscard]] Recording run(Eigen::Index rows) const {
    const Eigen::VectorXd setpoint = telegraph(seed + 1, rows, 40);
    const Eigen::VectorXd outside = telegraph(seed + 2, rows, 25), e = white(seed + 3, rows);
    Eigen::MatrixXd inputs(rows, 2), cvs(rows, 1);
    inputs.col(1) = outside;
    double disturbance = 0.0, one = 0.0, two = 0.0;
    const auto late = [&](Eigen::Index k, int input, Eigen::Index dead) {
      return k >= dead ? inputs(k - dead, input) : 0.0;
    };
    for (Eigen::Index k = 0; k < rows; ++k) {
      disturbance = 0.8 * disturbance + noise * e(k);
      cvs(k, 0) = one + two + disturbance;
      inputs(k, 0) = controller * ((setpoint_moves ? setpoint(k) : 0.0) - cvs(k, 0));
      const double p = std::exp(-1.0 / first.time_constant);
      const double q = std::exp(-1.0 / second.time_constant);
      one = p * one + first.gain * (1.0 - p) * late(k, 0, first.dead);
      two = q * two + second.gain * (1.0 - q) * late(k, 1, second.dead);
    }
    return recording_of(inputs, cvs);
  }
};

inline const ChannelAnswer& answer_of(const Identification& found, int cv, int input) {
  for (const ChannelAnswer& answer : found.channels)
    if (answer.cv == cv && answer.input == input) return answer;
  throw std::logic_error("no such channel");
}

/// Three inputs moved from outside, two CVs; what is hidden is not in `identify`'s sight.
inline Recording open_loop(Eigen::Index rows, std::uint64_t seed) {
  Eigen::MatrixXd inputs(rows, 3), cvs(rows, 2);
  inputs << telegraph(seed + 1, rows, 17), telegraph(seed + 2, rows, 23),
      telegraph(seed + 3, rows, 31);
  cvs.col(0) = first_order(inputs.col(0), 2.0, 12.0, 4) + first_order(inputs.col(2), -0.5, 30.0) +
               autoregressive(0.05 * white(seed + 4, rows), 0.9);
  cvs.col(1) =
      first_order(inputs.col(1), 1.5, 8.0, 1) + autoregressive(0.05 * white(seed + 5, rows), 0.7);
  inputs.col(0).array() += 40.0;
  cvs.col(1).array() += 100.0;
  return recording_of(inputs, cvs);
}

}  // namespace mpm::test
