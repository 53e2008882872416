#pragma once

#include <array>
#include <optional>
#include <string>

/// What can be hidden in a plant: the classes that the scores are given by.
namespace mpm::hidden {

enum class EffectClass {
  kNone,
  kGain,
  kDeadTime,
  kTimeConstant,
  kDynamics,     ///< two or three of the above in one channel
  kInputScale,   ///< the same gain error in every channel of an MV
  kOutputScale,  ///< the same in every channel of a CV
  kInputNonlinearity,
  kStiction,
  kOutputNonlinearity,
  kUnmodelledInput,
  kStep,  ///< of a CV: a disturbance or a sensor's offset
  kDrift,
  kPeriodic,
  kNoise,
  kTwoCauses,
  kOnsetGain,  ///< begins inside the part that is fitted
  kOnsetDeadTime,
  kUnnamed,      ///< something that no cause of the contract means
  kInputStuck,   ///< begins inside the part that is fitted
  kInputOffset,  ///< the same
  kProduct,      ///< a channel's gain goes with another MV
};

inline constexpr std::array kAllClasses = {EffectClass::kNone,
                                           EffectClass::kGain,
                                           EffectClass::kDeadTime,
                                           EffectClass::kTimeConstant,
                                           EffectClass::kDynamics,
                                           EffectClass::kInputScale,
                                           EffectClass::kOutputScale,
                                           EffectClass::kInputNonlinearity,
                                           EffectClass::kStiction,
                                           EffectClass::kOutputNonlinearity,
                                           EffectClass::kUnmodelledInput,
                                           EffectClass::kStep,
                                           EffectClass::kDrift,
                                           EffectClass::kPeriodic,
                                           EffectClass::kNoise,
                                           EffectClass::kTwoCauses,
                                           EffectClass::kOnsetGain,
                                           EffectClass::kOnsetDeadTime,
                                           EffectClass::kUnnamed,
                                           EffectClass::kInputStuck,
                                           EffectClass::kInputOffset,
                                           EffectClass::kProduct};

/// As the command line and the tables say it.
[[nodiscard]] const char* name_of(EffectClass effect_class);
[[nodiscard]] std::optional<EffectClass> class_named(const std::string& name);

}  // namespace mpm::hidden
