#include "sim/plant/recovery_boiler/boiler.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::sim::boiler {
namespace {

double radiated(double area, double gas, double wall) {
  return area * kStefanBoltzmann * (std::pow(gas + kZeroC, 4) - std::pow(wall + kZeroC, 4));
}

/// Sensible heat flow of a stream, W.
double sensible(double flow, double heat, double temperature) {
  return flow * heat * (temperature - kReference);
}

struct Gas {
  double co = 0.0, o2 = 0.0, co2 = 0.0, h2o = 0.0, rest = 0.0;  // kg/s
  [[nodiscard]] double flow() const { return co + o2 + co2 + h2o + rest; }
  void add_air(double air) {
    o2 += kO2OfAir * air;
    rest += (1.0 - kO2OfAir) * air;
  }
};

/// What the lower furnace makes of liquor, char and its air. All at once: oxygen is short there.
struct LowerFurnace {
  Gas gas;
  double char_rate = 0.0;                       // kg/s onto the bed, net
  double smelt = 0.0;                           // kg/s
  double heat = 0.0;                            // W, sensible and of reactions, before radiation
  double reaction = 0.0;                        // W, of it from reactions
  double dry = 0.0, water = 0.0, carbon = 0.0;  // kg/s in the liquor
};

constexpr double kOxygenOfHydrogen = kMolarO2 / (4.0 * 1.00794);  // kg O2 per kg H

LowerFurnace burn(double bed, const Inputs& in, const Condition& condition) {
  LowerFurnace lower;
  const double liquor = kLiquorDensity * in.liquor / 3600.0;
  lower.dry = liquor * condition.solids;
  lower.water = liquor - lower.dry;
  lower.carbon = kCarbon * lower.dry;
  const double hydrogen = kHydrogen * lower.dry;
  const double warmer = in.liquor_temperature - kLiquorTemperature;
  const double share = kCharShare * (1.0 - kCharFiner * warmer);
  const double size = std::max(1e-3, bed / kCharBed);
  const double burning = condition.char_burning * kCharBurning * std::pow(size, 2.0 / 3.0);
  lower.char_rate = share * lower.carbon - burning;

  const double reduced = std::clamp(kReduction * std::pow(size, kReductionOfBed), 0.0, 1.0);
  const double sulphate = (1.0 - reduced) * kSulphur * lower.dry;
  lower.smelt = kSmelt * lower.dry + kOxygenOfSulphate * sulphate;

  const double gasified = lower.carbon - lower.char_rate;
  const double oxygen = kO2OfAir * kLowerAir + kOxygen * lower.dry - kOxygenOfSulphate * sulphate -
                        kOxygenOfHydrogen * hydrogen;
  const double carbon_moles = gasified / kMolarC;
  const double to_co2 =
      std::clamp(2.0 * oxygen / kMolarO2 - carbon_moles, 0.0, carbon_moles);  // kmol/s
  Gas& gas = lower.gas;
  gas.co = (carbon_moles - to_co2) * kMolarCO;
  gas.co2 = to_co2 * kMolarCO2;
  gas.h2o = lower.water + hydrogen * (1.0 + kOxygenOfHydrogen);
  gas.o2 = oxygen - 0.5 * (carbon_moles + to_co2) * kMolarO2;
  gas.rest = (1.0 - kO2OfAir) * kLowerAir;

  lower.reaction = kHeatCToCO * gasified + kHeatCO * to_co2 * kMolarCO + kHeatH * hydrogen +
                   kHeatOfSulphate * sulphate - kEvaporation * lower.water -
                   kReductionHeat * lower.dry;
  lower.heat = lower.reaction + sensible(kLowerAir, kAirHeat, kLowerAirTemperature) +
               sensible(liquor, kLiquorHeat, in.liquor_temperature) -
               sensible(lower.smelt, kSmeltHeat, kSmeltTemperature);
  return lower;
}

/// A bundle in the gas: what it takes from a gas of that temperature, which is cooled.
double taken(double transfer, double flow, double metal, double& gas) {
  const double capacity = flow * kGasHeat;
  const double after = metal + (gas - metal) * std::exp(-transfer / capacity);
  const double heat = capacity * (gas - after);
  gas = after;
  return heat;
}

double boiling(double bar) { return kBoiling + kBoilingPerBar * (bar - kBar); }
double steam(double bar) { return kSteam + kSteamPerBar * (bar - kBar); }
double superheated(double enthalpy, double bar) {
  return boiling(bar) + (enthalpy - steam(bar)) / kSteamHeat;
}
double drum_pressure(double mass, double heat) {
  const double slope = mass * kWaterPerBar + kDrumMetal * kBoilingPerBar;
  return kBar + (heat - mass * kWater - kDrumMetal * kBoiling) / slope;
}

}  // namespace

Moment moment(const States& x, const Inputs& in, const Condition& condition) {
  Moment now{};
  States& rate = now.rates;
  Streams& out = now.streams;
  // Furnace.
  const LowerFurnace lower = burn(x[kChar], in, condition);
  const double lower_gas = kReference + x[kLowerHeat] / (kLowerGas * kGasHeat);
  const double upper_gas = kReference + x[kUpperHeat] / (kUpperGas * kGasHeat);
  out.pressure = drum_pressure(x[kDrumMass], x[kDrumHeat]);
  const double wall = boiling(out.pressure);
  const double lower_wall = radiated(kLowerWalls, lower_gas, wall);
  const double upper_wall = radiated(kUpperWalls, upper_gas, wall);
  const double radiant =
      condition.superheating * radiated(kRadiantSuperheater, upper_gas, x[kFinalMetal]);
  const double to_upper = lower.gas.flow();

  const double tertiary = kTertiaryDensity * (in.tertiary + condition.air_leak);
  Gas into = lower.gas;
  into.add_air(tertiary + kUpperAir);
  const double flow = into.flow();
  const double leaving = flow / kUpperGas;  // 1/s
  const double warmer = in.liquor_temperature - kLiquorTemperature;
  const double oxygen = std::max(0.0, x[kUpperO2] / kUpperGas);
  const double per_second = condition.oxidation * kOxidation *
                            std::pow(std::max(1e-3, in.tertiary / kTertiary), kMixing) *
                            (1.0 - kMixingFiner * warmer) * oxygen / (oxygen + kOxygenHalf);
  const double burnt = per_second * x[kUpperCO];  // kg CO/s

  rate[kChar] = lower.char_rate;
  rate[kDeposits] = (kDeposit * warmer - x[kDeposits]) / kDepositTime;
  rate[kLowerHeat] = lower.heat - lower_wall - sensible(to_upper, kGasHeat, lower_gas);
  const double upper_air = sensible(tertiary + kUpperAir, kAirHeat, kUpperAirTemperature);
  rate[kUpperHeat] = sensible(to_upper, kGasHeat, lower_gas) + upper_air + kHeatCO * burnt -
                     upper_wall - radiant - sensible(flow, kGasHeat, upper_gas);
  rate[kUpperCO] = into.co - leaving * x[kUpperCO] - burnt;
  rate[kUpperO2] = into.o2 - leaving * x[kUpperO2] - 0.5 * kMolarO2 / kMolarCO * burnt;
  rate[kUpperCO2] = into.co2 - leaving * x[kUpperCO2] + kMolarCO2 / kMolarCO * burnt;
  rate[kUpperH2O] = into.h2o - leaving * x[kUpperH2O];

  // Gas path.
  const double clean = 1.0 - x[kDeposits];
  const double foul = 1.0 - kDepositHot * x[kDeposits];
  double gas = upper_gas;
  const double final_gas =
      taken(foul * condition.superheating * kFinalSuperheater, flow, x[kFinalMetal], gas);
  const double first_gas =
      taken(foul * condition.superheating * kFirstSuperheater, flow, x[kFirstMetal], gas);
  const double bank = taken(clean * kBank, flow, wall, gas);
  const double economizer = taken(clean * kEconomizer, flow, x[kEconomizerTube], gas);
  out.stack_temperature = gas;

  // Drum, superheaters, attemperator.
  const double above = out.pressure * out.pressure - kHeader * kHeader;
  out.drum_flow = above > 0.0 ? kSteamValve * std::sqrt(above) : 0.0;
  const double water = kFeedwaterTemperature + (x[kEconomizerWater] - kFeedwater) / kFeedwaterHeat;
  const double into_water = kWaterSide * (x[kEconomizerTube] - water);
  rate[kEconomizerTube] = (economizer - into_water) / kEconomizerMetal;
  rate[kEconomizerWater] =
      (in.feedwater * (kFeedwater - x[kEconomizerWater]) + into_water) / kWaterHeld;
  rate[kDrumMass] = in.feedwater - out.drum_flow;
  rate[kDrumHeat] = in.feedwater * x[kEconomizerWater] - out.drum_flow * steam(out.pressure) +
                    lower_wall + upper_wall + bank;
  const double into_first =
      kSteamSide * (x[kFirstMetal] - superheated(x[kFirstSteam], out.pressure));
  rate[kFirstMetal] = (first_gas - into_first) / kSuperheaterMetal;
  rate[kFirstSteam] =
      (out.drum_flow * (steam(out.pressure) - x[kFirstSteam]) + into_first) / kSteamHeld;
  const double main = out.drum_flow + in.spray;
  const double mixed = out.drum_flow * x[kFirstSteam] + in.spray * kFeedwater;  // W
  const double into_final = kSteamSide * (x[kFinalMetal] - superheated(x[kFinalSteam], kHeader));
  rate[kFinalMetal] = (final_gas + radiant - into_final) / kSuperheaterMetal;
  rate[kFinalSteam] = (mixed - main * x[kFinalSteam] + into_final) / kSteamHeld;
  out.steam_flow = 3.6 * main;
  out.steam_temperature = superheated(x[kFinalSteam], kHeader);

  // Flue gas at the analyser, with what leaks in.
  Gas flue{leaving * x[kUpperCO], leaving * x[kUpperO2], leaving * x[kUpperCO2],
           leaving * x[kUpperH2O], 0.0};
  flue.rest = flow - flue.flow();
  const double carbon_out = kMolarC * (flue.co / kMolarCO + flue.co2 / kMolarCO2);
  Gas analysed = flue;
  analysed.add_air(kLeakage);
  const double co = analysed.co / kMolarCO, o2 = analysed.o2 / kMolarO2;
  const double dry = co + o2 + analysed.co2 / kMolarCO2 + analysed.rest / kMolarN2;
  out.excess_o2 = 100.0 * o2 / dry;
  out.co = 1e6 * co / dry;

  // Balances, the leakage left out.
  const double liquor = lower.dry + lower.water;
  out.mass_in = liquor + kLowerAir + tertiary + kUpperAir;
  out.mass_out = flow + lower.smelt;
  out.carbon_in = lower.carbon;
  out.carbon_out = carbon_out;
  const double unburnt = kHeatCToCO + kHeatCO * kMolarCO / kMolarC;  // J/kg C
  const double given = lower.reaction - kHeatCToCO * (lower.carbon - lower.char_rate) -
                       kHeatCO * (lower.gas.co2 / kMolarCO2) * kMolarCO;
  out.energy_in = unburnt * lower.carbon + given +
                  sensible(kLowerAir, kAirHeat, kLowerAirTemperature) +
                  sensible(liquor, kLiquorHeat, in.liquor_temperature) + upper_air +
                  (in.feedwater + in.spray) * kFeedwater;
  out.energy_out = sensible(flow, kGasHeat, out.stack_temperature) + kHeatCO * flue.co +
                   sensible(lower.smelt, kSmeltHeat, kSmeltTemperature) + main * x[kFinalSteam];
  return now;
}

Contents contents(const States& x) {
  const double unburnt = kHeatCToCO + kHeatCO * kMolarCO / kMolarC;
  return {kLowerGas + kUpperGas + x[kChar],
          x[kChar] + kMolarC * (x[kUpperCO] / kMolarCO + x[kUpperCO2] / kMolarCO2),
          unburnt * x[kChar] + kHeatCO * x[kUpperCO] + x[kLowerHeat] + x[kUpperHeat] +
              kSuperheaterMetal * (x[kFirstMetal] + x[kFinalMetal]) +
              kSteamHeld * (x[kFirstSteam] + x[kFinalSteam]) +
              kEconomizerMetal * x[kEconomizerTube] + kWaterHeld * x[kEconomizerWater] +
              x[kDrumHeat]};
}

States first_guess() {
  States x{};
  x[kChar] = kCharBed;
  x[kLowerHeat] = kLowerGas * kGasHeat * 1000.0;
  x[kUpperHeat] = kUpperGas * kGasHeat * 900.0;
  x[kUpperCO] = 3e-4 * kUpperGas;
  x[kUpperO2] = 0.04 * kUpperGas;
  x[kUpperCO2] = 0.2 * kUpperGas;
  x[kUpperH2O] = 0.13 * kUpperGas;
  x[kFirstMetal] = 400.0;
  x[kFirstSteam] = 3050e3;
  x[kFinalMetal] = 480.0;
  x[kFinalSteam] = 3250e3;
  x[kEconomizerTube] = 180.0;
  x[kEconomizerWater] = 800e3;
  x[kDrumMass] = kDrumWater;
  x[kDrumHeat] = kDrumWater * kWater + kDrumMetal * kBoiling;
  return x;
}

}  // namespace mpm::sim::boiler
