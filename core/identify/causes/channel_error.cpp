#include "core/identify/causes/channel_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/model/linear_model.hpp"
#include "core/text/number_text.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// Moments looked at for an error that began inside the data.
constexpr int kChannelErrorOnsets = 15;
/// A change can be told only if so much of the data lies on either side.
constexpr double kOnsetMargin = 0.1;
/// Moments are so much finer than those looked at: they are moved about later.
constexpr std::size_t kMomentsPerOnset = 8;

/// Ratios and dead times (samples) beyond which a channel is another one.
constexpr double kLeastGainRatio = 0.02, kMostGainRatio = 20.0;
constexpr double kMostLogRatio = 2.5;
constexpr double kMostDeadTime = 60.0;

/// A step response has settled within this share of its end; one that never does is looked at for
/// so many lags, and none for more samples.
constexpr double kSettled = 0.05, kRisingLags = 3.0;
constexpr int kLongestStep = 10000;

/// Steps of finite differences: small beside what is told apart, large beside rounding.
constexpr double kRatioStep = 0.01;
constexpr double kDeadTimeStep = 0.25;

Coordinate gain_ratio(double prior_sd) {
  return {.quantity = &kGainRatio,
          .value = 1.0,
          .prior_mean = 1.0,
          .prior_sd = prior_sd,
          .step = kRatioStep,
          .low = kLeastGainRatio,
          .high = kMostGainRatio};
}

Coordinate log_time_constant_ratio(double start, double prior_sd) {
  return {.quantity = &kTimeConstantRatio,
          .value = start,
          .prior_mean = 0.0,
          .prior_sd = prior_sd,
          .step = kRatioStep,
          .low = -kMostLogRatio,
          .high = kMostLogRatio};
}

Coordinate dead_time(double start, double removable, double prior_sd) {
  return {.quantity = &kDeadTimeError,
          .value = start,
          .prior_mean = 0.0,
          .prior_sd = prior_sd,
          .step = kDeadTimeStep,
          .low = -removable,
          .high = kMostDeadTime};
}

}  // namespace

Coordinate gain_ratio_coordinate() { return gain_ratio(0.25); }

Coordinate time_constant_coordinate(double start_log_ratio) {
  return log_time_constant_ratio(start_log_ratio, 0.35);
}

Coordinate dead_time_coordinate(double start_samples, double removable_samples) {
  return dead_time(start_samples, removable_samples, 3.0);
}

std::vector<Coordinate> open_channel_coordinates(double removable_samples) {
  return {gain_ratio(1.0), log_time_constant_ratio(0.0, 0.5),
          dead_time(0.0, removable_samples, 5.0)};
}

void edit_channels(const Effect& effect, const Surroundings& surroundings, ModelSpec& model) {
  const ChannelError error = {effect.value(kGainRatio, 1.0),
                              std::exp(effect.value(kTimeConstantRatio, 0.0)),
                              effect.value(kDeadTimeError, 0.0) * surroundings.sample_time_s,
                              std::exp(effect.value(kDampingRatio, 0.0))};
  for (ChannelSpec& channel : model.channels) {
    const bool meant = (effect.place.cv < 0 || channel.cv == effect.place.cv) &&
                       (effect.place.input < 0 || channel.input == effect.place.input);
    if (meant) channel = edited(channel, error, model.sample_time_s);
  }
}

double removable_samples(const ChannelSpec& channel, double sample_time_s) {
  return removable_dead_time_s(channel, sample_time_s) / sample_time_s;
}

bool has_own_gain(const ChannelSpec& channel) {
  return !std::holds_alternative<TankChain>(channel.dynamics);
}

Place place_of(const ChannelSpec& channel) { return {channel.cv, channel.input}; }

std::vector<ErrorOnset> error_onsets(const Recording& recording, bool elsewhere) {
  const double cost = cost_of(kMomentsPerOnset * kChannelErrorOnsets);
  std::vector<ErrorOnset> onsets = {{}};
  for (int i = 0; elsewhere && i < kChannelErrorOnsets; ++i) {
    const double share = kOnsetMargin + (1.0 - 2.0 * kOnsetMargin) * (i + 0.5) /
                                            static_cast<double>(kChannelErrorOnsets);
    onsets.push_back({static_cast<Index>(share * static_cast<double>(recording.samples())), cost});
  }
  if (recording.changed) onsets.push_back({*recording.changed, cost});
  return onsets;
}

int material_errors(const Effect& effect, const Tolerances& materiality) {
  const auto beyond = [](double error, double limit) { return std::abs(error) >= limit ? 1 : 0; };
  return beyond(effect.value(kGainRatio, 1.0) - 1.0, materiality.gain) +
         beyond(effect.value(kTimeConstantRatio, 0.0),
                std::log(1.0 + materiality.log_time_constant)) +
         beyond(effect.value(kDeadTimeError, 0.0), materiality.dead_time_samples);
}

double share_of_step(const Effect& effect, const Surroundings& surroundings,
                     const ModelSpec& model) {
  for (const ChannelSpec& channel : model.channels) {
    if (channel.cv != effect.place.cv || channel.input != effect.place.input) continue;
    ModelSpec edited = alone(channel, surroundings.sample_time_s);
    const LinearModel given(edited);
    Effect here = effect;
    here.place = place_of(edited.channels.front());
    edit_channels(here, surroundings, edited);
    const double rising =
        kRisingLags * given.slowest_time_constant_samples() + given.longest_dead_time_samples();
    const int samples = std::max(given.settling_samples(kSettled, kLongestStep),
                                 static_cast<int>(std::min<double>(rising, kLongestStep)));
    const auto response = [samples](const LinearModel& of) {
      Eigen::VectorXd step = of.impulse_response(0, 0, samples + 1);
      std::partial_sum(step.begin(), step.end(), step.begin());
      return step;
    };
    const Eigen::VectorXd without = response(given);
    const double size = without.norm();
    return size > 0.0 ? (response(LinearModel(edited)) - without).norm() / size : 0.0;
  }
  return 0.0;
}

void SingleChannelError::apply(const Effect& effect, const Surroundings& surroundings,
                               ModelSpec& model) const {
  edit_channels(effect, surroundings, model);
}

double SingleChannelError::rarity() const { return kNoRarity; }

std::optional<bool> SingleChannelError::matters(const Effect& mine,
                                                const Tolerances& materiality) const {
  return material_errors(mine, materiality) > 0;
}

const Cause* SingleChannelError::together_with_others() const { return &causes::dynamics(); }

std::string gain_sentence(const Finding& finding, const SignalNames& names) {
  const Parameter* ratio = finding.find(kGainRatio);
  if (ratio == nullptr) return {};
  const Place& place = finding.subject.place;
  return names.cv(place.cv).tag + " answers " + names.source(place).tag + " " +
         compared(ratio->value) + " than the model says (" + names.gains(place, ratio->value) +
         interval_of(*ratio) + " of the ratio). ";
}

std::string time_constant_sentence(const Finding& finding, const SignalNames& names) {
  const Parameter* ratio = finding.find(kTimeConstantRatio);
  if (ratio == nullptr) return {};
  const Place& place = finding.subject.place;
  const bool slow = ratio->value >= 1.0;
  return "The answer of " + names.cv(place.cv).tag + " to " + names.source(place).tag + " is " +
         number_text(slow ? ratio->value : 1.0 / ratio->value) + " times " +
         (slow ? "slower" : "faster") + " than the model's (time constant ratio " +
         interval_of(*ratio) + "). ";
}

std::string dead_time_sentence(const Finding& finding, const SignalNames& names) {
  const Parameter* error = finding.find(kDeadTimeError);
  if (error == nullptr) return {};
  const Place& place = finding.subject.place;
  const bool late = error->value >= 0.0;
  return names.cv(place.cv).tag + " answers " + names.source(place).tag + " " +
         number_text(std::abs(error->value)) + " s " + (late ? "later" : "sooner") +
         " than the model says (dead time error " + interval_of(*error, "s") + "). ";
}

}  // namespace mpm
