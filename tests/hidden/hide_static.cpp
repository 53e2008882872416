#include <algorithm>
#include <cmath>

#include "tests/hidden/draft.hpp"

// Sizes at full, as shares of the MV's 2 .. 98 % range in the healthy loop: stiction's band and
// deadband 4 .. 15 %, jump 0.3 .. 1 band; a saturation cuts off 10 .. 30 % at one end, or half of
// that at both; the quadratic changes the local gain by 20 .. 50 % from one end to the other, the
// cubic from the middle to the farther end. An actuator sticks 10 .. 90 % up its range, or is off
// by 10 .. 30 % of it. Clipping meets 3 .. 20 % of a healthy CV's samples.
namespace mpm::hidden {
namespace {

/// An input's element bends all of its channels; in a quarter of the cases only one is.
void place(Draft& draft, TrueEffect& effect, const Element& element) {
  if (!draft.chance(0.25)) {
    draft.plant.input_elements[static_cast<std::size_t>(effect.place.input)] = element;
    return;
  }
  std::vector<TrueChannel*> channels;
  for (TrueChannel& channel : draft.plant.channels)
    if (channel.input == effect.place.input) channels.push_back(&channel);
  TrueChannel& channel =
      *channels[static_cast<std::size_t>(draft.below(static_cast<int>(channels.size())))];
  channel.element = element;
  effect.place.cv = channel.cv;
}

Element bend(Draft& draft, TrueEffect& effect) {
  effect.cause = &causes::input_polynomial();
  const auto mv = static_cast<std::size_t>(effect.place.input);
  const double change = draft.size * draft.sign() * draft.between(0.2, 0.5);
  Bent bent;
  if (draft.hard) {
    const double farthest = std::max(-draft.healthy.mv_low[mv], draft.healthy.mv_high[mv]);
    bent.cubic = change / (3.0 * farthest * farthest);
    effect.parameters["cubic"] = bent.cubic;
  } else {
    bent.quadratic = change / (2.0 * draft.range_of(effect.place.input));
    effect.parameters["quadratic"] = bent.quadratic;
  }
  return bent;
}

Element limit(Draft& draft, TrueEffect& effect) {
  effect.cause = &causes::input_saturation();
  const auto mv = static_cast<std::size_t>(effect.place.input);
  const double cut = draft.size * draft.between(0.1, 0.3) * draft.range_of(effect.place.input);
  const bool both = draft.chance(0.5) && !draft.hard;
  const bool low = draft.chance(0.5);
  constexpr double kFar = 1e9;
  Limited limited{-kFar, kFar};
  const double share = both ? 0.5 : 1.0;
  const double origin = draft.plant.input_origin(effect.place.input);
  if (both || low) {
    limited.low = draft.healthy.mv_low[mv] + share * cut;
    effect.parameters["low"] = origin + limited.low;
  }
  if (both || !low) {
    limited.high = draft.healthy.mv_high[mv] - share * cut;
    effect.parameters["high"] = origin + limited.high;
  }
  return limited;
}

}  // namespace

void hide_input_nonlinearity(Draft& draft) {
  TrueEffect effect;
  effect.place.input = draft.below(draft.mv_count());
  Element element;
  switch (draft.below(3)) {
    case 0:
      element = bend(draft, effect);
      break;
    case 1:
      element = limit(draft, effect);
      break;
    default:
      effect.cause = &causes::deadband();
      element = Play{draft.size * draft.between(0.04, 0.15) * draft.range_of(effect.place.input)};
      effect.parameters["width"] = std::get<Play>(element).width;
  }
  place(draft, effect, element);
  draft.truth.push_back(effect);
}

void hide_stiction(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::stiction();
  effect.place.input = draft.below(draft.mv_count());
  Sticking valve;
  valve.band = draft.size * draft.between(0.04, 0.15) * draft.range_of(effect.place.input);
  valve.jump = valve.band * draft.between(0.3, 1.0);
  valve.slips_once = draft.hard;
  effect.parameters = {{"band", valve.band}, {"jump", valve.jump}};
  draft.plant.input_elements[static_cast<std::size_t>(effect.place.input)] = valve;
  draft.truth.push_back(effect);
}

/// Begins inside the fitted part, or was stuck from the start in a quarter of the cases.
void hide_input_stuck(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::input_stuck();
  const int mv = effect.place.input = draft.below(draft.mv_count());
  Standing standing;
  standing.value = draft.healthy.mv_low[static_cast<std::size_t>(mv)] +
                   draft.between(0.1, 0.9) * draft.range_of(mv);
  if (!draft.chance(0.25)) {
    standing.from = draft.onset_between(0.2, 0.6);
    effect.onset_s = draft.clock(standing.from);
  }
  effect.parameters["value"] = draft.plant.input_origin(mv) + standing.value;
  draft.plant.input_elements[static_cast<std::size_t>(mv)] = standing;
  draft.truth.push_back(effect);
}

void hide_input_offset(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::input_offset();
  effect.place.input = draft.below(draft.mv_count());
  Shifted shifted;
  shifted.size =
      draft.size * draft.sign() * draft.between(0.1, 0.3) * draft.range_of(effect.place.input);
  shifted.from = draft.onset_between(0.2, 0.6);
  effect.onset_s = draft.clock(shifted.from);
  effect.parameters["size"] = shifted.size;
  draft.plant.input_elements[static_cast<std::size_t>(effect.place.input)] = shifted;
  draft.truth.push_back(effect);
}

void hide_output_nonlinearity(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::output_saturation();
  effect.place.cv = draft.below(draft.plant.cv_count);
  const auto cv = static_cast<std::size_t>(effect.place.cv);
  const std::vector<double>& values = draft.healthy.cv_sorted[cv];
  const double share = draft.size * draft.between(0.03, 0.2);
  const bool both = draft.chance(0.5) && !draft.hard;
  const bool low = draft.chance(0.5);
  const auto count =
      static_cast<std::size_t>((both ? 0.5 : 1.0) * share * static_cast<double>(values.size()));
  constexpr double kFar = 1e9;
  Limited limits{-kFar, kFar};
  if (both || low) effect.parameters["low"] = limits.low = values[count];
  if (both || !low) effect.parameters["high"] = limits.high = values[values.size() - 1 - count];
  draft.plant.clipping[cv] = limits;
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
