#include "sim/plant/recovery_boiler/instruments.hpp"

#include <cmath>

namespace mpm::sim::boiler {
namespace {

constexpr double kStep = 1.0;  // s

// Lambda tuning (Rivera, Morari and Skogestad 1986): the integral time is the actuator's lag, which
// is also what the closed loop gets; % per unit of flow.
constexpr Pi::Tuning kAirTuning{100.0 / kFullAir, kFanTime};
constexpr Pi::Tuning kLiquorTuning{100.0 / kFullLiquor, kPumpTime};
constexpr Pi::Tuning kFeedwaterTuning{100.0 / kFullFeedwater, kPumpTime};
constexpr Pi::Tuning kHeaterTuning{3.0, 60.0};
constexpr Pi::Tuning kLevelTuning{1e-3, 600.0};  // kg/s, halved about 50, per kg of water

}  // namespace

double spray_flow(double position) {
  return kSprayPerPercent * std::max(0.0, std::min(position, 100.0) - kSprayCloses);
}

Instruments::Flow::Flow(const Pi::Tuning& tuning, double actuator_time, double full_flow,
                        double flow)
    : controller(tuning, 100.0 * flow / full_flow),
      actuator(actuator_time, 100.0 * flow / full_flow),
      sensor(kFlowSensorTime, flow),
      full(full_flow) {}

double Instruments::Flow::step(double setpoint) {
  const double output = controller.step(setpoint, sensor.value(), kStep);
  const double flow = full * actuator.step(output, kStep) / 100.0;
  sensor.step(flow, kStep);
  return flow;
}

Instruments::Instruments()
    : air_(kAirTuning, kFanTime, kFullAir, kTertiary),
      liquor_(kLiquorTuning, kPumpTime, kFullLiquor, kLiquor),
      feedwater_(kFeedwaterTuning, kPumpTime, kFullFeedwater, boiler_.streams().drum_flow),
      level_(kLevelTuning, 50.0),
      heater_(kHeaterTuning, (kLiquorTemperature - kHeaterCold) / kHeaterPerPercent),
      heater_outlet_(kHeaterTime, kLiquorTemperature),
      heater_sensor_(kLiquorThermometerTime, kLiquorTemperature),
      positioner_(kPositionerTime, kSprayValve),
      steam_flow_(kSteamFlowTime, boiler_.streams().steam_flow),
      steam_temperature_(kThermowellTime, boiler_.streams().steam_temperature),
      o2_(kO2Time, boiler_.streams().excess_o2),
      co_(kCOTime, boiler_.streams().co),
      o2_line_(kO2Line, boiler_.streams().excess_o2),
      co_line_(kCOLine, boiler_.streams().co) {
  const Streams& now = boiler_.streams();
  readings_ = {now.steam_flow, now.steam_temperature, now.excess_o2, now.co, kTertiary,
               kLiquor,        kLiquorTemperature,    kSprayValve};
}

void Instruments::advance(const SetPoints& setpoints, const Condition& condition,
                          const Faults& faults, int seconds) {
  for (int second = 0; second < seconds; ++second) one_second(setpoints, condition, faults);
}

void Instruments::one_second(const SetPoints& setpoints, const Condition& condition,
                             const Faults& faults) {
  Inputs inputs;
  inputs.tertiary = air_.step(setpoints.tertiary);
  inputs.liquor = liquor_.step(setpoints.liquor);

  const double heating = heater_.step(setpoints.liquor_temperature, heater_sensor_.value(), kStep);
  inputs.liquor_temperature = heater_outlet_.step(kHeaterCold + kHeaterPerPercent * heating, kStep);
  heater_sensor_.step(inputs.liquor_temperature, kStep);

  if (std::abs(setpoints.spray_valve - valve_command_) > faults.valve_stiction)
    valve_command_ = setpoints.spray_valve;
  inputs.spray = spray_flow(positioner_.step(valve_command_, kStep));

  // Three elements: level, steam flow, feedwater flow.
  const double level = level_.step(kDrumWater, boiler_.states()[kDrumMass], kStep) - 50.0;  // kg/s
  inputs.feedwater = feedwater_.step(boiler_.streams().drum_flow + level);

  boiler_.advance(inputs, condition, kStep);

  const Streams& now = boiler_.streams();
  o2_line_.push_back(now.excess_o2);
  co_line_.push_back(now.co);
  readings_.steam_flow = steam_flow_.step(now.steam_flow, kStep);
  readings_.steam_temperature = steam_temperature_.step(now.steam_temperature, kStep);
  readings_.excess_o2 = o2_.step(o2_line_.front(), kStep) + faults.o2_offset;
  readings_.co = co_.step(co_line_.front(), kStep);
  o2_line_.pop_front();
  co_line_.pop_front();
  readings_.tertiary = air_.sensor.value();
  readings_.liquor = liquor_.sensor.value();
  readings_.liquor_temperature = heater_sensor_.value();
  readings_.spray_valve = positioner_.value();
}

}  // namespace mpm::sim::boiler
