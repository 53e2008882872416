#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/hidden/draft.hpp"

// Sizes at full, in noise s.d. of the CV: step and drift 3 .. 10 (a drift by the end of the data),
// a periodic disturbance as much from crest to trough, an unmodelled input's effect 0.6 .. 1.5
// (s.d.). Noise: its variance grows 4 .. 12 times. Where a shape of the hard setting has no such
// number as the contract asks for (one lag, where there are two), the truth is silent about it.
namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSmallest = 3.0, kLargest = 10.0;

double deviation_of(const VectorXd& signal) {
  return std::sqrt((signal.array() - signal.mean()).square().mean());
}

/// A step that enters through no, one or two lags.
VectorXd lagged_step(const Draft& draft, int onset, double lag, double second_lag) {
  VectorXd result = VectorXd::Zero(draft.samples);
  double first = 0.0;
  double second = 0.0;
  for (Index k = onset; k < draft.samples; ++k) {
    const auto time = static_cast<double>(k - onset);
    first = lag > 0.0 ? 1.0 - std::exp(-time / lag) : 1.0;
    second =
        second_lag > 0.0 ? second + (first - second) * (1.0 - std::exp(-1.0 / second_lag)) : first;
    result(k) = second;
  }
  return result;
}

VectorXd step(Draft& draft, TrueEffect& effect, double size, int onset) {
  effect.onset_s = draft.clock(onset);
  effect.parameters["size"] = size;
  const double lag = draft.chance(0.5) ? 0.0 : draft.between(5.0, 40.0);
  if (lag > 0.0 && !draft.hard) effect.parameters["time_constant"] = draft.seconds(lag);
  return size * lagged_step(draft, onset, lag, draft.hard ? 0.5 * lag : 0.0);
}

/// With the hard setting some stop before the data end.
VectorXd drift(Draft& draft, TrueEffect& effect, double size, int onset) {
  effect.onset_s = draft.clock(onset);
  const double slope = size / (draft.samples - onset);
  const bool stops = draft.chance(0.5) && draft.hard;
  const int until = stops ? onset + (draft.samples - onset) / 2 : draft.samples;
  if (!stops) effect.parameters["rate"] = slope / draft.unit.sample_time_s;
  effect.parameters["size"] = slope * (std::min(draft.fit_samples, until) - onset);
  VectorXd result = VectorXd::Zero(draft.samples);
  for (int k = onset; k < draft.samples; ++k) result(k) = slope * (std::min(k, until) - onset);
  return result;
}

/// All the time; with the hard setting square and from an onset on.
VectorXd wave(Draft& draft, TrueEffect& effect, double size, int onset) {
  const double period = draft.between(20.0, 300.0);
  const double phase = draft.between(0.0, period);
  effect.parameters["period"] = draft.seconds(period);
  if (!draft.hard) effect.parameters["size"] = std::abs(size) / 2;
  if (draft.hard) effect.onset_s = draft.clock(onset);
  VectorXd result = VectorXd::Zero(draft.samples);
  for (int k = draft.hard ? onset : 0; k < draft.samples; ++k) {
    const double sine = std::sin(2.0 * std::numbers::pi * (k + phase) / period);
    result(k) = size / 2 * (draft.hard ? std::copysign(1.0, sine) : sine);
  }
  return result;
}

}  // namespace

void hide_disturbance(Draft& draft, EffectClass shape) {
  TrueEffect effect;
  effect.cause = shape == EffectClass::kStep    ? &causes::step_disturbance()
                 : shape == EffectClass::kDrift ? &causes::drift_disturbance()
                                                : &causes::periodic_disturbance();
  effect.place.cv = draft.below(draft.plant.cv_count);
  const double size = draft.size * draft.sign() * draft.between(kSmallest, kLargest) *
                      draft.noise_of(effect.place.cv);
  const int onset = draft.onset_between(0.1, 0.7);
  draft.plant.disturbance.col(effect.place.cv) +=
      shape == EffectClass::kStep    ? step(draft, effect, size, onset)
      : shape == EffectClass::kDrift ? drift(draft, effect, size, onset)
                                     : wave(draft, effect, size, onset);
  draft.truth.push_back(effect);
}

void hide_noise(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::noise();
  effect.place.cv = draft.below(draft.plant.cv_count);
  const int onset = draft.onset_between(0.1, 0.7);
  CvNoise& noise = draft.noise[static_cast<std::size_t>(effect.place.cv)];
  noise.variance_ratio = 1.0 + draft.size * (draft.between(4.0, 12.0) - 1.0);
  noise.onset = onset;
  effect.onset_s = draft.clock(onset);
  effect.parameters["variance_ratio"] = noise.variance_ratio;
  draft.truth.push_back(effect);
}

void hide_unmodelled_input(Draft& draft) {
  TrueEffect effect;
  effect.cause = &causes::unmodelled_input();
  effect.place.cv = draft.below(draft.plant.cv_count);
  effect.place.aux = draft.below(draft.plant.aux_count);
  TrueChannel channel;
  channel.cv = effect.place.cv;
  channel.input = draft.plant.input_count + effect.place.aux;
  const double lag = draft.between(5.0, 40.0);
  channel.time_constant = lag;
  channel.dead_time = draft.between(0.0, 8.0);
  if (draft.hard) channel.second_time_constant = lag * draft.between(0.3, 0.7);

  TruePlantSpec alone = draft.plant;
  alone.channels = {channel};
  alone.clipping.clear();
  alone.disturbance.resize(0, 0);
  const Eigen::MatrixXd still = Eigen::MatrixXd::Zero(draft.samples, draft.plant.input_count);
  const VectorXd unit_effect = simulate(alone, still, draft.aux).col(effect.place.cv);
  channel.gain = draft.size * draft.sign() * draft.between(0.6, 1.5) *
                 draft.noise_of(effect.place.cv) / deviation_of(unit_effect);
  draft.plant.channels.push_back(channel);
  effect.parameters["gain"] = channel.gain;
  if (!draft.hard) {
    effect.parameters["time_constant"] = draft.seconds(lag);
    effect.parameters["dead_time"] = draft.seconds(channel.dead_time);
  }
  draft.truth.push_back(effect);
}

}  // namespace mpm::hidden
