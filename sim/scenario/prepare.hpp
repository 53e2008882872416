#pragma once

#include <stdexcept>
#include <string>

#include "sim/loop/closed_loop.hpp"

namespace mpm::sim {

/// The model of another unit file with its signals in the order of `plant`, as the controller of
/// that plant needs it. Throws std::invalid_argument where a signal or the sample time differs.
[[nodiscard]] ModelSpec match_signals(const config::UnitConfig& controller,
                                      const config::UnitConfig& plant);

/// A plant that cannot be made, or that an offset-free controller could not hold
/// (where the scenario does not allow that).
class RefusedScenario : public std::invalid_argument {
 public:
  RefusedScenario(const config::Place& place, const std::string& scenario,
                  const std::string& reason);
  /// The reason at the place of the change that is too much; no place where it is in no file.
  [[nodiscard]] const config::Finding& finding() const { return finding_; }

 private:
  config::Finding finding_;
};

/// Fills in `setup.changes` from its scenario: named changes and what the draw adds. Throws
/// RefusedScenario with the reason, or std::invalid_argument where the scenario names what the unit
/// does not have.
void hide_changes(LoopSetup& setup);

}  // namespace mpm::sim
