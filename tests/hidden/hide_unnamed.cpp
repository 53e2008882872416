#include "tests/hidden/draft.hpp"

// What no cause of the contract means. Sizes at full: the gain swings by +-10 .. 25 %; rising takes
// 1.3 .. 2 times as long as falling.
namespace mpm::hidden {

void hide_unnamed(Draft& draft) {
  TrueEffect effect;
  TrueChannel& channel = any_slow_channel(draft);
  effect.place = {channel.cv, channel.input};
  if (draft.chance(0.5)) {
    effect.manner = "swinging_gain";
    channel.swing = draft.size * draft.between(0.1, 0.25);
    channel.swing_period = draft.between(150.0, 600.0);
    effect.parameters["swing"] = channel.swing;
  } else {
    effect.manner = "slower_up";
    channel.asymmetry = draft.size * draft.between(0.14, 0.4);
    effect.parameters["asymmetry"] = channel.asymmetry;
  }
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
