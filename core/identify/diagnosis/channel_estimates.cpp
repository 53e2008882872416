#include "core/identify/diagnosis/channel_estimates.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/statement.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// Whether a known effect is an error of this channel, which the estimate takes over.
bool is_error_of(const Effect& known, const Place& channel) {
  if (known.place.cv != channel.cv || known.place.input != channel.input) return false;
  const bool alone = known.edit == &causes::dead_time() || known.edit == &causes::time_constant();
  return alone || (known.onset == 0 && known.find(kGainRatio) != nullptr);
}

}  // namespace

std::vector<ChannelEstimate> estimate_channels(Problem& problem, const SearchResult& found,
                                               const SearchSettings& settings) {
  const double sample_time_s = problem.surroundings().sample_time_s;
  std::vector<ChannelEstimate> estimates;
  for (const ChannelSpec& channel : problem.model().channels) {
    if (settings.progress) settings.progress(kSearched);
    if (channel.input >= problem.surroundings().model_inputs) continue;
    Effect effect;
    effect.edit = &causes::dynamics();
    effect.place = place_of(channel);
    effect.coordinates = open_channel_coordinates(removable_samples(channel, sample_time_s));
    std::vector<Effect> effects;
    for (const Effect& known : found.fit.effects) {
      if (!is_error_of(known, effect.place)) {
        effects.push_back(known);
        continue;
      }
      for (Coordinate& coordinate : effect.coordinates)
        coordinate.value = known.value(*coordinate.quantity, coordinate.value);
    }
    effects.push_back(effect);
    const Fit fit = problem.fit(effects, effects.size() - 1, {channel.cv}, kEstimateSteps);
    const auto parameter = [&](Index i) {
      const Coordinate& c = fit.effects.back().coordinates[static_cast<std::size_t>(i)];
      // None where a small step away the model runs away: no more is known than beforehand.
      const double sd = fit.covariance.size() > 0 ? std::sqrt(fit.covariance(i, i)) : c.prior_sd;
      return stated(c, kNormalReach * sd, sample_time_s);
    };
    estimates.push_back({channel.cv, channel.input, parameter(0), parameter(1), parameter(2)});
  }
  return estimates;
}

std::ptrdiff_t unknown_gains(const std::vector<ChannelEstimate>& estimates) {
  return std::count_if(estimates.begin(), estimates.end(), [](const ChannelEstimate& estimate) {
    return estimate.gain_ratio.high - estimate.gain_ratio.low > 2.0 * kNormalReach * kBlindGainSd;
  });
}

bool has_gain_off(const std::vector<ChannelEstimate>& estimates) {
  return std::any_of(estimates.begin(), estimates.end(), [](const ChannelEstimate& estimate) {
    const double off = std::abs(estimate.gain_ratio.value - 1.0);
    const double sd = (estimate.gain_ratio.high - estimate.gain_ratio.low) / (2.0 * kNormalReach);
    return off - kSmall.gain > kNormalReach * sd ||
           (off > kSmall.gain && off > kBeyondDoubtSd * sd);
  });
}

}  // namespace mpm
