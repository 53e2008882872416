#include "core/identify/fit/effect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/fit/channel_edit.hpp"

namespace mpm {
namespace {

ChannelError channel_error(const Effect& effect, double sample_time_s) {
  return {effect.value("gain_ratio", 1.0), std::exp(effect.value("log_time_constant_ratio", 0.0)),
          effect.value("dead_time_samples", 0.0) * sample_time_s,
          std::exp(effect.value("log_damping_ratio", 0.0))};
}

void apply_to_channels(const Effect& effect, const Surroundings& s, ModelSpec& model) {
  const ChannelError error = channel_error(effect, s.sample_time_s);
  for (ChannelSpec& channel : model.channels) {
    const bool meant = (effect.subject.cv < 0 || channel.cv == effect.subject.cv) &&
                       (effect.subject.input < 0 || channel.input == effect.subject.input);
    if (meant) channel = edited(channel, error, s.sample_time_s);
  }
}

InputBlock input_block(const Effect& effect) {
  if (effect.subject.cause == Cause::kStiction)
    return Stiction{effect.value("band", 0.0), effect.value("jump", 0.0), effect.slips_once};
  if (effect.subject.kind == "saturation")
    return Saturation{effect.value("low", -1e300), effect.value("high", 1e300)};
  if (effect.subject.kind == "deadband") return Deadband{effect.value("width", 0.0)};
  Polynomial polynomial;
  polynomial.coefficients = {effect.value("linear", 1.0), effect.value("quadratic", 0.0),
                             effect.value("cubic", 0.0)};
  while (polynomial.coefficients.size() > 1 && polynomial.coefficients.back() == 0.0)
    polynomial.coefficients.pop_back();
  return polynomial;
}

void apply_block(const Effect& effect, ModelSpec& model) {
  const InputBlock block = input_block(effect);
  const auto input = static_cast<std::size_t>(effect.subject.input);
  if (effect.subject.cv < 0) {
    model.input_blocks[input] = block;
    return;
  }
  for (ChannelSpec& channel : model.channels)
    if (channel.cv == effect.subject.cv && channel.input == effect.subject.input)
      channel.input_block = block;
}

void apply_disturbance(const Effect& effect, const Surroundings& s, ModelSpec& model) {
  DisturbanceTerm term;
  term.cv = effect.subject.cv;
  term.onset_s = s.start_s + static_cast<double>(effect.onset) * s.sample_time_s;
  if (effect.subject.kind == "periodic") {
    term.shape = DisturbanceShape::kPeriodic;
    if (effect.find("period")) {
      term.square = true;
      term.size = effect.value("size", 0.0);
      term.period_s = effect.value("period", 1.0);
      term.onset_s = s.start_s + effect.value("begin", 0.0);
      model.disturbances.push_back(term);
      return;
    }
    const double sine = effect.value("sine", 0.0), cosine = effect.value("cosine", 0.0);
    const double frequency = effect.value("frequency", 1.0);  // Hz
    term.size = std::hypot(sine, cosine);
    term.period_s = 1.0 / frequency;
    // sine sin(w t) + cosine cos(w t) = size sin(w (t - onset)), t from the first row on
    term.onset_s = s.start_s - std::atan2(cosine, sine) / (2.0 * M_PI * frequency);
  } else if (effect.subject.kind == "drift") {
    term.shape = DisturbanceShape::kDrift;
    term.size = effect.value("rate", 0.0);
  } else {
    term.shape = DisturbanceShape::kStep;
    term.size = effect.value("size", 0.0);
    term.time_constant_s = effect.value("time_constant", 0.0);
  }
  model.disturbances.push_back(term);
}

void apply_new_channel(const Effect& effect, const Surroundings& s, ModelSpec& model) {
  TransferFunction transfer;
  transfer.gain = effect.value("gain", 0.0);
  transfer.time_constants_s = {std::exp(effect.value("log_time_constant", 0.0))};
  transfer.dead_time_s = std::max(0.0, effect.value("dead_time_samples", 0.0) * s.sample_time_s);
  const int input =
      effect.subject.aux >= 0 ? s.model_inputs + effect.subject.aux : effect.subject.input;
  model.channels.push_back({effect.subject.cv, input, transfer, {}});
}

void apply_state(const Effect& effect, const Surroundings& s, ModelSpec& model) {
  if (effect.subject.kind != "square_root_outflow") apply_to_channels(effect, s, model);
  const int cv = effect.subject.cv, input = effect.subject.input;
  if (effect.subject.kind == "cubic_stiffness") {
    model.state_terms.push_back(
        {cv, input, RestoringForce{effect.value("quadratic", 0.0), effect.value("cubic", 0.0)}});
  } else if (effect.subject.kind == "coulomb_friction") {
    model.state_terms.push_back(
        {cv, input, CoulombFriction{effect.value("force", 0.0), effect.value("speed", 1.0)}});
  } else if (effect.subject.kind == "square_root_outflow") {
    for (ChannelSpec& channel : model.channels) {
      if (channel.cv != cv || channel.input != input) continue;
      TankChain tanks;
      const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
      if (transfer == nullptr) return;
      for (std::size_t n = 0; n < transfer->time_constants_s.size(); ++n) {
        tanks.time_constants_s.push_back(
            transfer->time_constants_s[n] *
            std::exp(effect.value("log_time_constant_ratio_" + std::to_string(n + 1), 0.0)));
        tanks.overflow.push_back(effect.value("overflow_" + std::to_string(n + 1),
                                              std::numeric_limits<double>::infinity()));
      }
      tanks.empty_input = effect.value("empty_input", 0.0);
      tanks.empty_output = effect.value("empty_output", 0.0);
      tanks.spill = effect.value("spill", 0.0);
      tanks.dead_time_s = transfer->dead_time_s;
      channel.dynamics = tanks;
    }
  }
}

}  // namespace

double cost_of(std::size_t alternatives) {
  return 2.0 * std::log(static_cast<double>(std::max<std::size_t>(1, alternatives)));
}

const Coordinate* Effect::find(const std::string& name) const {
  for (const Coordinate& coordinate : coordinates)
    if (coordinate.name == name) return &coordinate;
  return nullptr;
}

double Effect::value(const std::string& name, double otherwise) const {
  const Coordinate* coordinate = find(name);
  return coordinate ? coordinate->value : otherwise;
}

void apply(const Effect& effect, const Surroundings& surroundings, ModelSpec& model) {
  switch (effect.subject.cause) {
    case Cause::kGain:
    case Cause::kDeadTime:
    case Cause::kTimeConstant:
    case Cause::kDynamics:
    case Cause::kInputScale:
    case Cause::kOutputScale:
      apply_to_channels(effect, surroundings, model);
      break;
    case Cause::kInputNonlinearity:
    case Cause::kStiction:
      if (effect.find("dead_time_samples")) apply_to_channels(effect, surroundings, model);
      apply_block(effect, model);
      break;
    case Cause::kOutputNonlinearity:
      model.output_blocks[static_cast<std::size_t>(effect.subject.cv)] =
          Saturation{effect.value("low", -1e300), effect.value("high", 1e300)};
      break;
    case Cause::kUnmodelledInput:
      apply_new_channel(effect, surroundings, model);
      break;
    case Cause::kOutputDisturbance:
      apply_disturbance(effect, surroundings, model);
      break;
    case Cause::kStateNonlinearity:
      apply_state(effect, surroundings, model);
      break;
    case Cause::kNoise:
    case Cause::kUnnamed:
      break;
  }
}

bool knows_onset(const Effect& effect) {
  return effect.subject.cause == Cause::kOutputDisturbance && effect.subject.kind != "periodic";
}

bool touches(const Effect& effect, const ModelSpec& model, int cv) {
  if (effect.subject.cv >= 0) return effect.subject.cv == cv;
  return std::any_of(model.channels.begin(), model.channels.end(), [&](const ChannelSpec& channel) {
    return channel.cv == cv && channel.input == effect.subject.input;
  });
}

}  // namespace mpm
