#include "core/identify/fit/effect.hpp"

#include <algorithm>

namespace mpm {

const Coordinate* Effect::find(const Quantity& quantity, int number) const {
  for (const Coordinate& coordinate : coordinates)
    if (coordinate.quantity == &quantity && coordinate.number == number) return &coordinate;
  return nullptr;
}

double Effect::value(const Quantity& quantity, double otherwise, int number) const {
  const Coordinate* coordinate = find(quantity, number);
  return coordinate ? coordinate->value : otherwise;
}

void apply(const Effect& effect, const Surroundings& surroundings, ModelSpec& model) {
  effect.edit->apply(effect, surroundings, model);
}

bool touches(const Effect& effect, const ModelSpec& model, int cv) {
  if (effect.place.cv >= 0) return effect.place.cv == cv;
  return std::any_of(model.channels.begin(), model.channels.end(), [&](const ChannelSpec& channel) {
    return channel.cv == cv && channel.input == effect.place.input;
  });
}

}  // namespace mpm
