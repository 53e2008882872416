#include <algorithm>
#include <cmath>

#include "tests/hidden/draft.hpp"

// Sizes at full: gain 10 .. 30 %, a whole MV or CV 10 .. 25 %, either sign; time constant -30 ..
// -15 or +20 .. +60 %; dead time +2 .. +6 samples, but not far above half the lag, or in a third of
// the channels that have 2 samples as much less, as far as there is dead time.
namespace mpm::hidden {
namespace {

constexpr double kVisibleLag = 3.0;  ///< samples; shorter time constants show in no sampled data
constexpr double kShorterDeadTime = 2.0;

double gain_ratio(Draft& draft, double largest) {
  return 1.0 + draft.size * draft.sign() * draft.between(0.1, largest);
}

double time_constant_ratio(Draft& draft) {
  const double slower = draft.between(0.2, 0.6);
  const double faster = draft.between(-0.3, -0.15);
  return 1.0 + draft.size * (draft.chance(0.5) ? slower : faster);
}

double dead_time_error(Draft& draft, const TrueChannel& channel) {
  const double size = draft.between(2.0, std::clamp(0.5 * channel.time_constant, 3.0, 6.0));
  const bool shorter = draft.chance(1.0 / 3);
  if (!shorter || channel.dead_time < kShorterDeadTime) return draft.size * size;
  return -draft.size * std::min(size, channel.dead_time);
}

TrueEffect about(const Cause& cause, const TrueChannel& channel) {
  TrueEffect effect;
  effect.cause = &cause;
  effect.place = {channel.cv, channel.input};
  return effect;
}

void hide_gain(Draft& draft, TrueChannel& channel, TrueEffect& effect) {
  const double ratio = gain_ratio(draft, 0.3);
  channel.gain *= ratio;
  effect.parameters["gain_ratio"] = ratio;
}

void hide_time_constant(Draft& draft, TrueChannel& channel, TrueEffect& effect) {
  const double ratio = time_constant_ratio(draft);
  channel.time_constant *= ratio;
  effect.parameters["time_constant_ratio"] = ratio;
}

void hide_dead_time(Draft& draft, TrueChannel& channel, TrueEffect& effect) {
  const double error = dead_time_error(draft, channel);
  channel.dead_time += error;
  effect.parameters["dead_time_error"] = draft.seconds(error);
}

TrueEffect hide_several(Draft& draft, TrueChannel& channel) {
  TrueEffect effect = about(causes::dynamics(), channel);
  const int left_out = draft.below(4);  // 3 = all three
  if (left_out != 0) hide_gain(draft, channel, effect);
  if (left_out != 1) hide_time_constant(draft, channel, effect);
  if (left_out != 2) hide_dead_time(draft, channel, effect);
  return effect;
}

TrueEffect hide_in_all(Draft& draft, EffectClass effect_class) {
  const bool input = effect_class == EffectClass::kInputScale;
  const double ratio = gain_ratio(draft, 0.25);
  TrueEffect effect;
  effect.cause = input ? &causes::input_scale() : &causes::output_scale();
  (input ? effect.place.input : effect.place.cv) =
      draft.below(input ? draft.mv_count() : draft.plant.cv_count);
  effect.parameters["gain_ratio"] = ratio;
  for (TrueChannel& channel : draft.plant.channels)
    if (channel.input == effect.place.input || channel.cv == effect.place.cv) channel.gain *= ratio;
  return effect;
}

/// Splits a channel in two, one before and one after an onset inside the fitted part. With the hard
/// setting a changed gain lets out what had gone in before.
TrueEffect hide_change(Draft& draft, EffectClass effect_class, std::size_t place) {
  const bool gain = effect_class == EffectClass::kOnsetGain;
  const int onset = draft.onset_between(0.2, 0.6);
  TrueChannel after = draft.plant.channels[place];
  TrueEffect effect = about(gain ? causes::gain() : causes::dead_time(), after);
  if (gain)
    hide_gain(draft, after, effect);
  else
    hide_dead_time(draft, after, effect);
  effect.onset_s = draft.clock(onset);
  after.from = onset;
  after.switched_at_input = draft.hard && gain;
  TrueChannel& before = draft.plant.channels[place];
  before.until = onset;
  before.switched_at_input = after.switched_at_input;
  draft.plant.channels.push_back(after);
  return effect;
}

std::size_t channel_for(Draft& draft, EffectClass effect_class) {
  const bool lag =
      effect_class == EffectClass::kTimeConstant || effect_class == EffectClass::kDynamics;
  for (;;) {
    const auto place =
        static_cast<std::size_t>(draft.below(static_cast<int>(draft.plant.channels.size())));
    const TrueChannel& channel = draft.plant.channels[place];
    if (channel.input >= draft.plant.input_count) continue;  // an aux signal's
    if (!lag || channel.time_constant >= kVisibleLag) return place;
  }
}

}  // namespace

void hide_in_channel(Draft& draft, EffectClass effect_class) {
  if (effect_class == EffectClass::kInputScale || effect_class == EffectClass::kOutputScale) {
    draft.truth.push_back(hide_in_all(draft, effect_class));
    return;
  }
  const std::size_t place = channel_for(draft, effect_class);
  if (effect_class == EffectClass::kOnsetGain || effect_class == EffectClass::kOnsetDeadTime) {
    draft.truth.push_back(hide_change(draft, effect_class, place));
    return;
  }
  TrueChannel& channel = draft.plant.channels[place];
  TrueEffect effect = about(causes::gain(), channel);
  if (effect_class == EffectClass::kGain) {
    hide_gain(draft, channel, effect);
  } else if (effect_class == EffectClass::kTimeConstant) {
    effect.cause = &causes::time_constant();
    hide_time_constant(draft, channel, effect);
  } else if (effect_class == EffectClass::kDeadTime) {
    effect.cause = &causes::dead_time();
    hide_dead_time(draft, channel, effect);
  } else {
    effect = hide_several(draft, channel);
  }
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
