#pragma once

/// Constants of the recovery boiler (boiler.hpp), SI units, temperatures in degC unless
/// said otherwise. docs/recovery_boiler.md has the source of each, or the word "assumed".
namespace mpm::sim::boiler {

// physics:
inline constexpr double kZeroC = 273.15;                 ///< K
inline constexpr double kStefanBoltzmann = 5.670374e-8;  ///< W/(m2 K4)
inline constexpr double kReference = 25.0;               ///< sensible heat is counted from here
inline constexpr double kMolarC = 12.011, kMolarO2 = 31.998, kMolarN2 = 28.158, kMolarCO = 28.010,
                        kMolarCO2 = 44.009, kMolarH2O = 18.015;  ///< kg/kmol; N2 with argon
inline constexpr double kO2OfAir = 0.2314;                       ///< by mass, dry
inline constexpr double kHeatCToCO = 9.21e6;                     ///< J/kg C
inline constexpr double kHeatCO = 10.10e6;                       ///< J/kg CO
inline constexpr double kHeatH = 119.96e6;                       ///< J/kg H, water as vapour
inline constexpr double kEvaporation = 2.442e6;                  ///< J/kg water at kReference
inline constexpr double kGasHeat = 1280.0;  ///< J/(kg K), flue gas, mean of 25 to 1100 degC
inline constexpr double kAirHeat = 1010.0;  ///< J/(kg K)

// black liquor:
inline constexpr double kLiquorDensity = 1350.0;  ///< kg/m3
inline constexpr double kLiquorHeat = 2900.0;     ///< J/(kg K)
inline constexpr double kSolids = 0.65;           ///< kg dry solids per kg
inline constexpr double kCarbon = 0.32;           ///< burnable, kg/kg dry solids
inline constexpr double kHydrogen = 0.035;        ///< kg/kg dry solids
inline constexpr double kOxygen = 0.20;           ///< bound in what burns, kg/kg dry solids
inline constexpr double kSulphur = 0.045;         ///< kg/kg dry solids
/// Leaves as smelt, kg/kg dry solids, where all sulphur is reduced: what does not burn.
inline constexpr double kSmelt = 1.0 - kCarbon - kHydrogen - kOxygen;
inline constexpr double kSmeltTemperature = 850.0;
inline constexpr double kSmeltHeat = 1350.0;        ///< J/(kg K)
inline constexpr double kOxygenOfSulphate = 1.996;  ///< kg O2 per kg S that is not reduced
inline constexpr double kHeatOfSulphate = 30.6e6;   ///< J per kg S that is not reduced

// furnace:
inline constexpr double kLowerAir = 86.0;  ///< kg/s, primary and secondary, held
inline constexpr double kLowerAirTemperature = 150.0;
inline constexpr double kUpperAir = 44.0;          ///< kg/s, quaternary and through openings, held
inline constexpr double kTertiaryDensity = 0.898;  ///< kg/m3 at its 120 degC and 1 atm
inline constexpr double kUpperAirTemperature = 120.0;
inline constexpr double kTertiary = 30.0;            ///< m3/s, Table 5.4
inline constexpr double kLiquorTemperature = 130.0;  ///< Table 5.4
inline constexpr double kCharShare = 0.25;           ///< of the carbon, lands on the bed
inline constexpr double kCharFiner = 0.015;  ///< less of that per K of liquor: finer drops, 1/K
inline constexpr double kCharBed = 1000.0;   ///< kg carbon at the operating point
inline constexpr double kLiquor = 135.0;     ///< m3/h, Table 5.4
/// kg/s of it there: what lands.
inline constexpr double kCharBurning =
    kCharShare * kCarbon * kSolids * kLiquorDensity * kLiquor / 3600.0;
inline constexpr double kReduction = 0.93;                        ///< of the sulphur, at that bed
inline constexpr double kReductionOfBed = 0.5;                    ///< exponent of the bed's size
inline constexpr double kLowerGas = 250.0, kUpperGas = 280.0;     ///< kg, held by draft control
inline constexpr double kLowerWalls = 90.0, kUpperWalls = 420.0;  ///< m2, times emissivity
inline constexpr double kOxidation = 313.12;   ///< 1/s, CO to CO2 at the operating point
inline constexpr double kOxygenHalf = 0.004;   ///< mass fraction of O2 that halves it
inline constexpr double kMixing = 0.35;        ///< exponent of the tertiary air
inline constexpr double kMixingFiner = 0.006;  ///< less per K of liquor, 1/K

// heat exchangers:
inline constexpr double kRadiantSuperheater = 18.0;  ///< m2 seen by the furnace, times emissivity
inline constexpr double kFinalSuperheater = 71.3e3, kFirstSuperheater = 75e3, kBank = 330e3,
                        kEconomizer = 350e3;                   ///< W/K, gas side
inline constexpr double kSteamSide = 600e3, kWaterSide = 3e6;  ///< W/K, metal to steam, to water
inline constexpr double kSuperheaterMetal = 25e6, kEconomizerMetal = 40e6;  ///< J/K
inline constexpr double kSteamHeld = 900.0, kWaterHeld = 20e3;              ///< kg
inline constexpr double kDeposit = 0.026;      ///< of bank and economizer, per K of liquor, 1/K
inline constexpr double kDepositHot = 0.18;    ///< of the superheaters, beside that
inline constexpr double kDepositTime = 400.0;  ///< s, laid down and blown off

// steam and water, linear about 90 bar (IAPWS-IF97):
inline constexpr double kBar = 90.0;
inline constexpr double kWater = 1363.7e3, kWaterPerBar = 4.55e3;   ///< J/kg, saturated
inline constexpr double kSteam = 2742.9e3, kSteamPerBar = -1.66e3;  ///< J/kg, saturated
inline constexpr double kBoiling = 303.3, kBoilingPerBar = 0.80;
inline constexpr double kSteamHeat = 3480.0;  ///< J/(kg K), mean of superheating to 444 degC
inline constexpr double kFeedwater = 510e3, kFeedwaterTemperature = 120.0;
inline constexpr double kFeedwaterHeat = 4400.0;  ///< J/(kg K)
inline constexpr double kHeader = 85.0;           ///< bar, held by the turbines
inline constexpr double kSteamValve = 3.38;       ///< kg/(s bar)
inline constexpr double kDrumWater = 100e3;       ///< kg
inline constexpr double kDrumMetal = 1e8;         ///< J/K, with the risers

// actuators and sensors:
inline constexpr double kSprayValve = 30.0;   ///< %, Table 5.4
inline constexpr double kSpray = 26.0 / 3.6;  ///< kg/s there
inline constexpr double kSprayCloses = 26.2;  ///< %, lower end of the valve's range
inline constexpr double kSprayPerPercent = kSpray / (kSprayValve - kSprayCloses);      ///< kg/s
inline constexpr double kFullAir = 60.0, kFullLiquor = 200.0, kFullFeedwater = 150.0;  ///< at 100 %
inline constexpr double kFanTime = 4.0, kPumpTime = 3.0, kPositionerTime = 2.0;        ///< s
inline constexpr double kFlowSensorTime = 1.0;
inline constexpr double kHeaterCold = 110.0, kHeaterPerPercent = 0.4, kHeaterTime = 60.0;
inline constexpr double kLiquorThermometerTime = 8.0, kSteamFlowTime = 5.0, kThermowellTime = 15.0;
inline constexpr double kO2Time = 10.0, kCOTime = 15.0;  ///< s, of the analysers
inline constexpr int kO2Line = 8, kCOLine = 20;          ///< s, of the gas on its way to them

// what nobody controls:
inline constexpr double kSolidsTime = 600.0;         ///< s, in which the liquor's solids wander
inline constexpr double kSolidsInnovation = 1.5e-4;  ///< kg/kg per sample; 0.8e-3 s.d. at 10 s

// so that the operating point is that of Table 5.4:
inline constexpr double kReductionHeat = 3.0617e6;  ///< J/kg dry solids, pyrolysis and reduction
inline constexpr double kLeakage = 27.1;            ///< kg/s air between furnace and analyser

}  // namespace mpm::sim::boiler
