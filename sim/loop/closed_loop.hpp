#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "config/scenario_config.hpp"
#include "core/signal/frame.hpp"
#include "sim/mpc/mpc.hpp"
#include "sim/plant/plant.hpp"
#include "sim/plant/process.hpp"
#include "sim/signals/coloured_noise.hpp"
#include "sim/signals/intervals.hpp"
#include "sim/signals/output_disturbance.hpp"
#include "sim/signals/setpoints.hpp"
#include "sim/signals/test_signals.hpp"

namespace mpm::sim {

/// What a closed-loop run is made of, all by index.
struct LoopSetup {
  config::UnitConfig unit;             ///< signals, plant model, limits, disturbances
  ModelSpec controller_model;          ///< same signals in the same order
  config::ScenarioConfig scenario;     ///< noise, set-points and controller of the run
  std::vector<ChannelChange> changes;  ///< what is hidden in the plant
  std::uint64_t seed = 1;
  std::int64_t start_time_ns = 0;            ///< source time of k = 0
  std::optional<std::int64_t> samples = {};  ///< length of the run where it has an end
};

/// Plant, noise, set-points and controller, one control interval at a time, in the convention of
/// `Frame`: y(k) is measured, then u(k) computed, which acts until k+1.
/// The same setup gives the same numbers. No allocation after construction.
class ClosedLoop {
 public:
  /// Throws std::invalid_argument where the setup defines no loop.
  explicit ClosedLoop(const LoopSetup& setup);

  /// Runs the next interval. The frame stays valid until the next call.
  [[nodiscard]] const Frame& step();

  /// y(k) of the last frame without noise and disturbances.
  [[nodiscard]] const Eigen::VectorXd& true_output() const { return true_output_; }
  /// False once a value is no longer finite.
  [[nodiscard]] bool finite() const { return finite_; }
  [[nodiscard]] const Mpc& controller() const { return controller_; }

 private:
  double sample_time_s_;
  std::int64_t start_time_ns_;
  std::int64_t interval_ = 0;
  std::unique_ptr<Process> plant_;
  Mpc controller_;
  RandomBinarySetpoints setpoints_;
  OutputDisturbance output_disturbance_;
  std::vector<ColouredNoise> movement_, aux_movement_;
  std::vector<IntervalRange> controller_off_;
  TestSignals tests_;
  Eigen::VectorXd disturbance_origin_;
  Eigen::VectorXd true_output_;
  Eigen::VectorXd input_;  ///< of the plant: MVs, DVs, and the aux signals where they act
  Frame frame_;
  bool finite_ = true;
};

/// The plant of a setup. Throws std::invalid_argument where there is no such process.
[[nodiscard]] std::unique_ptr<Process> make_process(const LoopSetup& setup);

/// The unit's simulation settings with the scenario's MV limits.
[[nodiscard]] config::SimulationSettings limited_settings(const config::UnitConfig& unit,
                                                          const config::ScenarioConfig& scenario);

/// Share of the output disturbance that the scenario's controller feeds back: 1 with integral
/// action; without it what `disturbance_feedback` says, or nothing if that says 1.
[[nodiscard]] double feedback_share(const config::ScenarioConfig& scenario);

}  // namespace mpm::sim
