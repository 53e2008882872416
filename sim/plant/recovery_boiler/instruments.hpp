#pragma once

#include <deque>

#include "sim/plant/recovery_boiler/control_blocks.hpp"
#include "sim/plant/recovery_boiler/running_boiler.hpp"

namespace mpm::sim::boiler {

/// What the layer above writes.
struct SetPoints {
  double tertiary = kTertiary;  ///< m3/s
  double liquor = kLiquor;      ///< m3/h
  double liquor_temperature = kLiquorTemperature;
  double spray_valve = kSprayValve;  ///< %
};

/// What the layer above reads.
struct Readings {
  double steam_flow, steam_temperature, excess_o2, co;  ///< units as Streams
  double tertiary, liquor, liquor_temperature, spray_valve;
};

/// What may be wrong with instruments and actuators.
struct Faults {
  double valve_stiction = 0.0;  ///< % that the command must move before the spray valve does
  double o2_offset = 0.0;       ///< % that the analyser reads too much
};

/// The boiler behind its low-level control: loops of air flow, liquor flow, liquor temperature and
/// drum level, the spray valve's positioner, and all sensors, each second.
class Instruments {
 public:
  Instruments();

  /// `seconds`: whole ones.
  void advance(const SetPoints& setpoints, const Condition& condition, const Faults& faults,
               int seconds);

  [[nodiscard]] const Readings& readings() const { return readings_; }
  [[nodiscard]] const RunningBoiler& boiler() const { return boiler_; }

 private:
  /// A flow, its actuator (0 to 100 %) and its sensor.
  struct Flow {
    Flow(const Pi::Tuning& tuning, double actuator_time, double full, double flow);
    double step(double setpoint);
    Pi controller;
    Lag actuator;  ///< %
    Lag sensor;
    double full;  ///< at 100 %
  };
  void one_second(const SetPoints& setpoints, const Condition& condition, const Faults& faults);

  RunningBoiler boiler_;
  Flow air_, liquor_, feedwater_;
  Pi level_, heater_;
  Lag heater_outlet_, heater_sensor_;
  Lag positioner_;
  double valve_command_ = kSprayValve;  ///< %, that the spray valve follows
  Lag steam_flow_, steam_temperature_, o2_, co_;
  std::deque<double> o2_line_, co_line_;  ///< on the way to the analysers
  Readings readings_{};
};

/// kg/s through the spray valve.
[[nodiscard]] double spray_flow(double position);

}  // namespace mpm::sim::boiler
