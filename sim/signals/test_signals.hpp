#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario_config.hpp"
#include "sim/signals/intervals.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

/// MVs that are tested by two levels around their operating point while the controller is off.
class TestSignals {
 public:
  TestSignals(const std::vector<config::TestSignal>& tests, const std::vector<std::string>& mvs,
              const Eigen::VectorXd& origin, double sample_time_s, std::uint64_t seed);

  /// Moves on to an interval, one after the other; whether any test lasts.
  [[nodiscard]] bool advance(std::int64_t interval);
  /// What the MVs are to be; those without a test are at the operating point.
  [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }

 private:
  struct Test {
    Eigen::Index mv;
    double size;
    std::int64_t hold;
    bool random;
    IntervalRange when;
    RandomStream stream;
    double level;
  };
  std::vector<Test> tests_;
  Eigen::VectorXd origin_, values_;
};

}  // namespace mpm::sim
