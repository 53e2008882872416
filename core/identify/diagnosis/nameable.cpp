#include "core/identify/diagnosis/nameable.hpp"

#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"

namespace mpm {
namespace {

using Shares = std::vector<std::optional<double>>;

bool is_of_an_actuator(const Effect& effect) {
  return effect.edit == &causes::input_stuck() || effect.edit == &causes::input_offset();
}

double outside_share(const Shares& shares, int input) {
  const auto i = static_cast<std::size_t>(input);
  return i < shares.size() ? shares[i].value_or(1.0) : 1.0;
}

/// The most of any input that acts through the effect's channels.
double outside_share(const Effect& effect, const ModelSpec& model, const Shares& shares) {
  if (effect.place.aux >= 0) return 1.0;
  if (effect.place.input >= 0) return outside_share(shares, effect.place.input);
  double most = 0.0;
  for (const ChannelSpec& channel : model.channels)
    if (channel.cv == effect.place.cv) most = std::max(most, outside_share(shares, channel.input));
  return most;
}

/// What of the channels only an input that moves from outside the loop can show. A valve that
/// sticks moves its loop by itself, one that has stuck opens it.
double outside_needed(const Effect& effect) {
  const Cause& cause = cause_of(effect);
  if (cause.is_curve()) return kCurveOutside;
  const bool by_itself =
      effect.edit == &causes::stiction() || effect.edit == &causes::input_stuck();
  return cause.acts_through_channels() && !by_itself ? kHardlyOutside : 0.0;
}

}  // namespace

bool is_error_of_channel(const Effect& effect) {
  return cause_of(effect).together_with_others() != nullptr;
}

// A valve frees gain and lags beside its own.
bool is_scale(const Effect& effect) {
  return !is_error_of_channel(effect) && !cause_of(effect).is_input_block() &&
         (effect.find(kGainRatio) != nullptr || effect.find(kTimeConstantRatio) != nullptr ||
          effect.find(kDeadTimeError) != nullptr);
}

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
                                            const ChannelTests& nonlinear, const Shares& shares) {
  return [&model, ranges, &tests, &nonlinear, &shares](const Effect& effect) {
    if (is_of_an_actuator(effect) && effect.place.input >= ranges.mvs) return false;
    const bool bends = effect.place.aux < 0 && cause_of(effect).is_curve() &&
                       nonlinear.bends(channels_of(effect, model, ranges.inputs));
    if (outside_share(effect, model, shares) < outside_needed(effect) && !bends) return false;
    if (effect.place.aux >= ranges.aux) return may_name_setpoint(effect, tests, ranges.aux);
    if (causes::is_constant_offset(effect))
      return !tests.reject(tests.channels_to(effect.place.cv));
    if (!cause_of(effect).acts_through_channels()) return true;
    if (bends) return true;
    Effect asked = effect;
    if (cause_of(effect).is_curve() && effect.place.input >= 0) asked.place.cv = -1;
    const std::vector<std::pair<int, int>> channels = channels_of(asked, model, ranges.inputs);
    // What began later is less in the mean of all rows than since then.
    const bool has_to_matter =
        cause_of(effect).is_curve() || (is_scale(effect) && effect.onset == 0);
    return tests.reject(channels) && (!has_to_matter || tests.may_matter(channels));
  };
}

}  // namespace mpm
