#include "tests/hidden/draft.hpp"

// Another MV changes a channel's gain. Size at full: by +-10 .. 25 % from the middle of its range
// to the end.
namespace mpm::hidden {

TrueChannel& any_slow_channel(Draft& draft) {
  std::vector<TrueChannel*> channels;
  for (TrueChannel& channel : draft.plant.channels)
    if (channel.input < draft.mv_count() && channel.time_constant >= 3.0)
      channels.push_back(&channel);
  return *channels[static_cast<std::size_t>(draft.below(static_cast<int>(channels.size())))];
}

void hide_product(Draft& draft) {
  TrueChannel& channel = any_slow_channel(draft);
  channel.modulator = (channel.input + 1 + draft.below(draft.mv_count() - 1)) % draft.mv_count();
  channel.modulation = draft.size * draft.sign() * draft.between(0.1, 0.25) /
                       (0.5 * draft.range_of(channel.modulator));
  TrueEffect effect;
  effect.cause = &causes::input_product();
  effect.place = {channel.cv, channel.input};
  effect.other_input = channel.modulator;
  effect.parameters["per_unit"] = channel.modulation;
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
