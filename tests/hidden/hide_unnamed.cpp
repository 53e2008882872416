#include <algorithm>
#include <cmath>

#include "tests/hidden/draft.hpp"

// What no cause of the contract means. Sizes at full: another MV changes the gain by +-10 .. 25 %
// over its range; the gain swings by +-10 .. 25 %; rising takes 1.3 .. 2 times as long as falling.
namespace mpm::hidden {

void hide_unnamed(Draft& draft) {
  TrueEffect effect;
  std::vector<TrueChannel*> channels;
  for (TrueChannel& channel : draft.plant.channels)
    if (channel.input < draft.mv_count() && channel.time_constant >= 3.0)
      channels.push_back(&channel);
  TrueChannel& channel =
      *channels[static_cast<std::size_t>(draft.below(static_cast<int>(channels.size())))];
  effect.place = {channel.cv, channel.input};
  switch (draft.below(3)) {
    case 0: {
      effect.manner = "product";
      channel.modulator =
          (channel.input + 1 + draft.below(draft.mv_count() - 1)) % draft.mv_count();
      channel.modulation = draft.size * draft.sign() * draft.between(0.1, 0.25) /
                           (0.5 * draft.range_of(channel.modulator));
      effect.parameters["modulation"] = channel.modulation;
      break;
    }
    case 1:
      effect.manner = "swinging_gain";
      channel.swing = draft.size * draft.between(0.1, 0.25);
      channel.swing_period = draft.between(150.0, 600.0);
      effect.parameters["swing"] = channel.swing;
      break;
    default:
      effect.manner = "slower_up";
      channel.asymmetry = draft.size * draft.between(0.14, 0.4);
      effect.parameters["asymmetry"] = channel.asymmetry;
  }
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
