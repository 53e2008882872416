#include "tests/hidden/draft.hpp"

#include <stdexcept>

namespace mpm::hidden {
namespace {

/// Bends or scales what goes through channels, in place of adding to a CV.
bool in_channels(const TrueEffect& effect) {
  return effect.place.aux < 0 && !same_name(effect.cause, &causes::step_disturbance()) &&
         effect.cause != &causes::noise() && effect.cause != &causes::output_saturation();
}

bool meet(int one, int other) { return one < 0 || other < 0 || one == other; }

}  // namespace

void hide(Draft& draft, EffectClass effect_class) {
  switch (effect_class) {
    case EffectClass::kGain:
    case EffectClass::kDeadTime:
    case EffectClass::kTimeConstant:
    case EffectClass::kDynamics:
    case EffectClass::kInputScale:
    case EffectClass::kOutputScale:
    case EffectClass::kOnsetGain:
    case EffectClass::kOnsetDeadTime:
      return hide_in_channel(draft, effect_class);
    case EffectClass::kInputNonlinearity:
      return hide_input_nonlinearity(draft);
    case EffectClass::kStiction:
      return hide_stiction(draft);
    case EffectClass::kInputStuck:
      return hide_input_stuck(draft);
    case EffectClass::kInputOffset:
      return hide_input_offset(draft);
    case EffectClass::kOutputNonlinearity:
      return hide_output_nonlinearity(draft);
    case EffectClass::kUnmodelledInput:
      return hide_unmodelled_input(draft);
    case EffectClass::kStep:
    case EffectClass::kDrift:
    case EffectClass::kPeriodic:
      return hide_disturbance(draft, effect_class);
    case EffectClass::kNoise:
      return hide_noise(draft);
    case EffectClass::kUnnamed:
      return hide_unnamed(draft);
    case EffectClass::kProduct:
      return hide_product(draft);
    case EffectClass::kNone:
    case EffectClass::kTwoCauses:
      break;
  }
  throw std::invalid_argument("not a single effect");
}

bool separable(const TrueEffect& one, const TrueEffect& other) {
  if (same_name(one.cause, other.cause)) return false;
  return !(in_channels(one) && in_channels(other) && meet(one.place.cv, other.place.cv) &&
           meet(one.place.input, other.place.input));
}

}  // namespace mpm::hidden
