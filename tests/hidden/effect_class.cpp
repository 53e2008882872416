#include "tests/hidden/effect_class.hpp"

namespace mpm::hidden {

const char* name_of(EffectClass effect_class) {
  switch (effect_class) {
    case EffectClass::kNone:
      return "none";
    case EffectClass::kGain:
      return "gain";
    case EffectClass::kDeadTime:
      return "dead_time";
    case EffectClass::kTimeConstant:
      return "time_constant";
    case EffectClass::kDynamics:
      return "dynamics";
    case EffectClass::kInputScale:
      return "input_scale";
    case EffectClass::kOutputScale:
      return "output_scale";
    case EffectClass::kInputNonlinearity:
      return "input_nonlinearity";
    case EffectClass::kStiction:
      return "stiction";
    case EffectClass::kOutputNonlinearity:
      return "output_nonlinearity";
    case EffectClass::kUnmodelledInput:
      return "unmodelled_input";
    case EffectClass::kStep:
      return "step";
    case EffectClass::kDrift:
      return "drift";
    case EffectClass::kPeriodic:
      return "periodic";
    case EffectClass::kNoise:
      return "noise";
    case EffectClass::kTwoCauses:
      return "two_causes";
    case EffectClass::kOnsetGain:
      return "onset_gain";
    case EffectClass::kOnsetDeadTime:
      return "onset_dead_time";
    case EffectClass::kUnnamed:
      return "unnamed";
    case EffectClass::kInputStuck:
      return "input_stuck";
    case EffectClass::kInputOffset:
      return "input_offset";
    case EffectClass::kProduct:
      return "product";
  }
  return "";
}

std::optional<EffectClass> class_named(const std::string& name) {
  for (const EffectClass effect_class : kAllClasses)
    if (name == name_of(effect_class)) return effect_class;
  return std::nullopt;
}

}  // namespace mpm::hidden
