#include "core/identify/diagnosis/nameable.hpp"

#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/calibration.hpp"

namespace mpm {
namespace {

bool is_of_an_actuator(const Effect& effect) {
  return effect.edit == &causes::input_stuck() || effect.edit == &causes::input_offset();
}

bool is_curve(const Effect& effect) {
  const auto curves = {&causes::input_polynomial(), &causes::input_saturation(),
                       &causes::cubic_stiffness(), &causes::square_root_outflow(),
                       &causes::coulomb_friction()};
  return std::any_of(curves.begin(), curves.end(),
                     [&](const Cause* curve) { return effect.edit == curve; });
}

}  // namespace

std::vector<std::pair<int, int>> channels_of(const Effect& effect, const ModelSpec& model,
                                             int model_inputs) {
  const Place& place = effect.place;
  const int input = place.aux >= 0 ? model_inputs + place.aux : place.input;
  if (place.cv >= 0 && input >= 0) return {{place.cv, input}};
  std::vector<std::pair<int, int>> channels;
  for (const ChannelSpec& channel : model.channels)
    if ((place.cv < 0 || channel.cv == place.cv) && (input < 0 || channel.input == input))
      channels.emplace_back(channel.cv, channel.input);
  return channels;
}

std::function<bool(const Effect&)> nameable(const ModelSpec& model, const SignalRanges& ranges,
                                            const ChannelTests& tests,
                                            const std::vector<std::optional<double>>& shares) {
  return [&model, ranges, &tests, &shares](const Effect& effect) {
    const auto input = static_cast<std::size_t>(effect.place.input);
    if (is_of_an_actuator(effect) && effect.place.input >= ranges.mvs) return false;
    if (is_curve(effect) && input < shares.size() && shares[input].value_or(1.0) < kCurveOutside)
      return false;
    return !cause_of(effect).acts_through_channels() || effect.place.aux >= ranges.aux ||
           tests.reject(channels_of(effect, model, ranges.inputs));
  };
}

}  // namespace mpm
