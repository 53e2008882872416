#pragma once

#include <vector>

#include "config/scenario_config.hpp"
#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"

namespace mpm::report {

/// The limits that hold in a scenario: the unit file's with the scenario's over them.
[[nodiscard]] std::vector<config::MvLimits> limits_in(const config::UnitConfig& unit,
                                                      const config::ScenarioConfig& scenario);

/// How well a loop controls, summed over its frames.
class LoopTally {
 public:
  LoopTally(const config::UnitConfig& unit, std::vector<config::MvLimits> limits);

  void add(const Frame& frame);

  /// Of set-point minus CV; NaN where no set-point was seen.
  [[nodiscard]] double error_variance(int cv) const;
  /// Share of the samples, 0..1.
  [[nodiscard]] double at_limit(int mv) const;

 private:
  struct Sum {
    double count = 0.0, sum = 0.0, squares = 0.0;
  };
  std::vector<config::MvLimits> limits_;
  std::vector<Sum> errors_;   ///< one per CV
  std::vector<Sum> resting_;  ///< one per MV; sum counts samples at a limit
};

}  // namespace mpm::report
