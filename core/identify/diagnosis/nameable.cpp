#include "core/identify/diagnosis/nameable.hpp"

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"

namespace mpm {
namespace {

bool is_of_an_actuator(const Effect& effect) {
  return effect.edit == &causes::input_stuck() || effect.edit == &causes::input_offset();
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
    if (cause_of(effect).is_curve() && input < shares.size() &&
        shares[input].value_or(1.0) < kCurveOutside)
      return false;
    if (effect.place.aux >= ranges.aux) return may_name_setpoint(effect, tests, ranges.aux);
    return !cause_of(effect).acts_through_channels() ||
           tests.reject(channels_of(effect, model, ranges.inputs));
  };
}

}  // namespace mpm
