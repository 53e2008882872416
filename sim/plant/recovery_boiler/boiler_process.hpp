#pragma once

#include <string>
#include <vector>

#include "config/scenario_config.hpp"
#include "sim/plant/process.hpp"
#include "sim/plant/recovery_boiler/instruments.hpp"
#include "sim/signals/coloured_noise.hpp"
#include "sim/signals/intervals.hpp"

namespace mpm::sim::boiler {

/// The recovery boiler as a unit's process. MVs in this order: tertiary air (m3/s), liquor flow
/// (m3/h), liquor temperature (degC), spray valve (%); CVs: steam flow (t/h), steam temperature
/// (degC), excess O2 (%), CO (ppm); no DVs. Aux signals, as many as the unit has: the measured air,
/// liquor flow, liquor temperature, valve position, and dry solids of the liquor (%), which wander.
class BoilerProcess : public Process {
 public:
  /// Throws std::invalid_argument where the unit has other signals, or no whole seconds.
  BoilerProcess(const config::UnitConfig& unit, const std::vector<config::ProcessChange>& changes,
                std::uint64_t seed);

  [[nodiscard]] int input_count() const override { return 4; }
  void set_time_s(double) override {}
  [[nodiscard]] const Eigen::VectorXd& output() const override { return output_; }
  void advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;
  [[nodiscard]] const Eigen::VectorXd& measured_aux() const override { return aux_; }

  /// What a scenario may change.
  [[nodiscard]] static std::vector<std::string> quantities();

 private:
  struct Change {
    std::size_t quantity;
    double value;
    IntervalRange when;
  };
  void read();

  Instruments plant_;
  std::vector<Change> changes_;
  int seconds_;
  std::int64_t interval_ = 0;
  ColouredNoise solids_;
  double solids_now_ = kSolids;
  Eigen::VectorXd output_, aux_;
};

}  // namespace mpm::sim::boiler
