#include "sim/plant/channel_change.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/model/linear_model.hpp"

namespace mpm::sim {
namespace {

/// Length of a step response that stands for a channel: all but this share of it has settled.
constexpr double kSettled = 1e-9;

int find(const std::vector<std::string>& tags, const std::string& tag) {
  const auto place = std::find(tags.begin(), tags.end(), tag);
  if (place == tags.end()) throw std::invalid_argument("no signal '" + tag + "' in this unit");
  return static_cast<int>(place - tags.begin());
}

ChannelSpec* find_channel(ModelSpec& model, int cv, int input) {
  for (ChannelSpec& channel : model.channels)
    if (channel.cv == cv && channel.input == input) return &channel;
  return nullptr;
}

/// Of the linear part.
StepResponse step_response_of(const ModelSpec& model, int cv, int input) {
  ModelSpec one = model;
  one.channels.clear();
  one.state_terms.clear();
  one.disturbances.clear();
  for (const ChannelSpec& channel : model.channels)
    if (channel.cv == cv && channel.input == input) one.channels.push_back(channel);
  const LinearModel simulator(one);
  if (simulator.integrating()(cv, input))
    throw std::invalid_argument(
        "an integrating channel can be changed so only as a transfer function");
  constexpr int kLongest = 100000;
  const int length = simulator.settling_samples(kSettled, kLongest) + 2;
  const Eigen::VectorXd pulse = simulator.impulse_response(cv, input, length);
  StepResponse response;
  double sum = 0.0;
  for (const double value : pulse) response.values.push_back(sum += value);
  return response;
}

/// values(t) -> values(dead + (t - dead - error) / ratio), linear between samples. `dead` is the
/// last sample before the response begins.
StepResponse stretched(const StepResponse& response, double ratio, double error_samples) {
  const std::vector<double>& values = response.values;
  std::size_t begin = 0;
  while (begin + 1 < values.size() && values[begin + 1] == 0.0) ++begin;
  const auto dead = static_cast<double>(begin);
  if (dead + error_samples < 0.0)
    throw std::invalid_argument("the dead time would become negative");
  const auto last = static_cast<double>(values.size() - 1);
  const auto length =
      static_cast<std::size_t>(std::ceil(dead + error_samples + (last - dead) * ratio)) + 1;
  StepResponse result;
  for (std::size_t i = 0; i < length; ++i) {
    const double at = dead + (static_cast<double>(i) - dead - error_samples) / ratio;
    const double clamped = std::clamp(at, 0.0, last);
    const auto left = static_cast<std::size_t>(clamped);
    const std::size_t right = std::min(left + 1, values.size() - 1);
    const double share = clamped - static_cast<double>(left);
    result.values.push_back(values[left] + share * (values[right] - values[left]));
  }
  result.values.front() = 0.0;
  return result;
}

void apply(const ChannelChange& change, TransferFunction& transfer) {
  transfer.gain *= change.gain_ratio;
  for (double& time_constant_s : transfer.time_constants_s)
    time_constant_s *= change.time_constant_ratio;
  transfer.dead_time_s += change.dead_time_error_s;
  if (transfer.dead_time_s < 0.0)
    throw std::invalid_argument("the dead time would become negative");
}

/// A level that answers by so much more has its empty vessel so much further down.
void apply(const ChannelChange& change, double output_origin, TankChain& tanks) {
  tanks.empty_output = output_origin - change.gain_ratio * (output_origin - tanks.empty_output);
  for (double& time_constant_s : tanks.time_constants_s)
    time_constant_s *= change.time_constant_ratio;
  tanks.dead_time_s += change.dead_time_error_s;
  if (tanks.dead_time_s < 0.0) throw std::invalid_argument("the dead time would become negative");
}

/// Gains of a state space in one whole row, column or cell without leaving that form.
bool scale_state_space(const ChannelChange& change, ModelSpec& model) {
  StateSpaceSpec& system = *model.state_space;
  const bool only_cv = model.cv_count == 1;
  const bool only_input = model.input_count == 1;
  if (only_cv) {
    system.b.col(change.input) *= change.gain_ratio;
  } else if (only_input) {
    system.c.row(change.cv) *= change.gain_ratio;
  } else {
    return false;
  }
  system.d(change.cv, change.input) *= change.gain_ratio;
  return true;
}

void split_state_space(ModelSpec& model) {
  if (model.state_space->x0.size() != 0 && !model.state_space->x0.isZero())
    throw std::invalid_argument("a state space that starts from x0 cannot be changed by channel");
  std::vector<ChannelSpec> channels;
  for (int cv = 0; cv < model.cv_count; ++cv)
    for (int input = 0; input < model.input_count; ++input)
      if (has_channel(model, cv, input))
        channels.push_back({cv, input, step_response_of(model, cv, input)});
  model.state_space.reset();
  model.channels = std::move(channels);
}

void apply(const ChannelChange& change, ModelSpec& model) {
  const bool gain_only = change.time_constant_ratio == 1.0 && change.dead_time_error_s == 0.0;
  if (model.state_space) {
    if (gain_only && scale_state_space(change, model)) return;
    split_state_space(model);
  }
  ChannelSpec* channel = find_channel(model, change.cv, change.input);
  if (channel == nullptr) throw std::invalid_argument("the model has no such channel");
  if (auto* transfer = std::get_if<TransferFunction>(&channel->dynamics)) {
    apply(change, *transfer);
    return;
  }
  if (auto* tanks = std::get_if<TankChain>(&channel->dynamics)) {
    apply(change, model.output_origin.size() != 0 ? model.output_origin(change.cv) : 0.0, *tanks);
    return;
  }
  const double shift = change.dead_time_error_s / model.sample_time_s;
  auto* filter = std::get_if<DiscreteFilter>(&channel->dynamics);
  const bool whole = std::abs(shift - std::round(shift)) < 1e-9;
  if (filter != nullptr && change.time_constant_ratio == 1.0 && whole &&
      filter->delay_samples + std::lround(shift) >= 0) {
    filter->delay_samples += static_cast<int>(std::lround(shift));
    for (double& coefficient : filter->numerator) coefficient *= change.gain_ratio;
    return;
  }
  StepResponse response = filter != nullptr ? step_response_of(model, change.cv, change.input)
                                            : std::get<StepResponse>(channel->dynamics);
  if (!gain_only) response = stretched(response, change.time_constant_ratio, shift);
  for (double& value : response.values) value *= change.gain_ratio;
  channel->dynamics = std::move(response);
}

}  // namespace

bool has_channel(const ModelSpec& model, int cv, int input) {
  if (!model.state_space)
    return std::any_of(
        model.channels.begin(), model.channels.end(),
        [&](const ChannelSpec& channel) { return channel.cv == cv && channel.input == input; });
  const auto order = static_cast<int>(model.state_space->a.rows());
  return !LinearModel(model).impulse_response(cv, input, order + 3).isZero(0.0);
}

std::vector<ChannelChange> resolve_changes(const std::vector<config::Change>& changes,
                                           const config::UnitConfig& unit) {
  const std::vector<std::string> inputs = unit.input_tags();
  const std::vector<std::string> cvs = unit.cv_tags();
  std::vector<ChannelChange> resolved;
  for (const config::Change& change : changes) {
    const int only_cv = change.cv ? find(cvs, *change.cv) : -1;
    const int only_input = change.mv ? find(inputs, *change.mv) : -1;
    const std::size_t before = resolved.size();
    for (int cv = 0; cv < static_cast<int>(cvs.size()); ++cv) {
      for (int input = 0; input < static_cast<int>(inputs.size()); ++input) {
        const bool every_mv = only_input < 0 && input < static_cast<int>(unit.mv.size());
        if ((only_cv >= 0 && cv != only_cv) || (input != only_input && !every_mv) ||
            !has_channel(unit.model, cv, input))
          continue;
        resolved.push_back({cv, input, change.gain_ratio, change.time_constant_ratio,
                            change.dead_time_error_s, change.from_s, change.until_s});
      }
    }
    if (resolved.size() == before)
      throw std::invalid_argument("the model has no channel " + change.mv.value_or("(any)") +
                                  " -> " + change.cv.value_or("(any)"));
  }
  return resolved;
}

ModelSpec changed_model(const ModelSpec& model, const std::vector<ChannelChange>& changes) {
  ModelSpec result = model;
  for (const ChannelChange& change : changes) apply(change, result);
  return result;
}

}  // namespace mpm::sim
