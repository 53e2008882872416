#pragma once

#include <cstdint>
#include <limits>
#include <ostream>
#include <vector>

#include "sim/loop/closed_loop.hpp"

namespace mpm::sim {

/// From which error on one channel's mismatch costs the controller more than it should.
struct ChannelLimit {
  struct Value {
    double error = 0.0;   ///< of the direction that needs the smaller one
    bool capped = false;  ///< no error up to `error`, the largest looked at, costs so much
  };
  int cv = 0;
  int input = 0;
  Value gain;           ///< relative: gain (1 +- error)
  Value time_constant;  ///< relative: all time constants times or over (1 + error)
  Value dead_time;      ///< s, more or less
};

/// Length and number of the runs that a cost is the mean of.
struct CostRuns {
  std::int64_t samples = 1000;
  int seeds = 3;  ///< setup.seed and the following
};

/// The controller's own cost, as it turned out: sum of (r - y)' W (r - y) + du' Wd du over the
/// runs, y being the measured CVs. `enough` ends the sum early once it is above. Infinite where the
/// loop diverges.
[[nodiscard]] double control_cost(const LoopSetup& setup, const CostRuns& runs,
                                  double enough = std::numeric_limits<double>::infinity());

/// For every channel of the unit's model, by bisection, the errors at which the cost is `rise`
/// (0.2 = 20 %) above that without a mismatch. Runs with the unit's noise, disturbances and
/// set-points, each with the same random numbers: what a mismatch costs is to be weighed against
/// what the loop costs in any case, and noise that the controller amplifies is part of it. Errors
/// are looked at from 1/128 of the caps on: 1.0 of the gain, 1.0 of the time constants (twice or
/// half), 20 samples of dead time; resolution 4 %. Throws std::invalid_argument where the loop has
/// no cost to compare with.
[[nodiscard]] std::vector<ChannelLimit> materiality_limits(const LoopSetup& setup, double rise,
                                                           const CostRuns& runs = {});

/// As a block of the unit file.
void print_limits(std::ostream& out, const LoopSetup& setup,
                  const std::vector<ChannelLimit>& limits, double rise, const CostRuns& runs = {});

}  // namespace mpm::sim
