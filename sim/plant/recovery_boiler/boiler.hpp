#pragma once

#include <array>
#include <cstddef>

#include "sim/plant/recovery_boiler/parameters.hpp"

/// First-principles model of a recovery boiler: furnace with char bed, water walls and drum, two
/// superheaters with an attemperator between them, boiler bank, economizer (Carlsson 2010, ch. 5).
/// Gas holdups and steam holdups have constant mass; everything else follows from balances of mass,
/// of the elements and of energy, which hold exactly.
namespace mpm::sim::boiler {

enum State : std::size_t {
  kChar,       ///< kg carbon on the bed
  kDeposits,   ///< share of the heat transfer that deposits cost
  kLowerHeat,  ///< J, sensible heat of the gas in the lower furnace
  kUpperHeat,  ///< J
  kUpperCO,    ///< kg in the upper furnace
  kUpperO2,
  kUpperCO2,
  kUpperH2O,
  kFirstMetal,  ///< degC
  kFirstSteam,  ///< J/kg, at the outlet
  kFinalMetal,
  kFinalSteam,
  kEconomizerTube,
  kEconomizerWater,  ///< J/kg, at the outlet
  kDrumMass,         ///< kg water
  kDrumHeat,         ///< J, water and metal
  kStates,
};
using States = std::array<double, kStates>;

/// What actuators do to it.
struct Inputs {
  double tertiary = kTertiary;  ///< m3/s at 120 degC
  double liquor = kLiquor;      ///< m3/h
  double liquor_temperature = kLiquorTemperature;
  double spray = kSpray;     ///< kg/s
  double feedwater = 101.0;  ///< kg/s, into the economizer
};

/// What nobody tells the controller about.
struct Condition {
  double oxidation = 1.0;     ///< of CO to CO2, times
  double superheating = 1.0;  ///< heat transfer of both superheaters from the gas, times
  double solids = kSolids;    ///< of the liquor
  double char_burning = 1.0;  ///< times
  double air_leak = 0.0;      ///< m3/s that go past the tertiary air's measurement into the furnace
};

/// What sensors see, and what balances are made of.
struct Streams {
  double steam_flow = 0.0;         ///< t/h, with the spray
  double steam_temperature = 0.0;  ///< degC
  double excess_o2 = 0.0;          ///< % of dry flue gas
  double co = 0.0;                 ///< ppm of dry flue gas
  double pressure = 0.0;           ///< bar, of the drum
  double stack_temperature = 0.0;
  double drum_flow = 0.0;                    ///< kg/s steam from the drum
  double mass_in = 0.0, mass_out = 0.0;      ///< kg/s, gas side; water and steam have their own
  double carbon_in = 0.0, carbon_out = 0.0;  ///< kg/s
  double energy_in = 0.0, energy_out = 0.0;  ///< W, with what may still burn
};

struct Moment {
  States rates;  ///< of change of the states, per second
  Streams streams;
};
[[nodiscard]] Moment moment(const States& states, const Inputs& inputs, const Condition& condition);

/// What the states hold, for balances: kg gas and char, kg carbon, J.
struct Contents {
  double mass, carbon, energy;
};
[[nodiscard]] Contents contents(const States& states);

/// Near the operating point.
[[nodiscard]] States first_guess();

}  // namespace mpm::sim::boiler
