#include "core/model/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/archive/archive.hpp"
#include "core/model/calibration.hpp"
#include "core/model/disturbance.hpp"
#include "core/model/input_history.hpp"
#include "core/model/model_definition.hpp"
#include "core/model/static_blocks.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
namespace watched = calibration::settling_horizon;
using BoolMatrix = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// The unit-step response of one channel stays within `tolerance` from the returned sample on.
int settling_of(LinearModel& channel, const ChannelFacts& facts, double tolerance, int limit) {
  if (facts.unstable) return limit;
  const auto order = static_cast<double>(facts.order);
  const double horizon = facts.dead_time + watched::kSamples +
                         facts.slowest * (watched::kTimeConstants + watched::kPerOrder * order +
                                          watched::kPerLogTolerance * std::log1p(1.0 / tolerance));
  const int length = horizon < limit ? static_cast<int>(horizon) : limit;
  channel.reset();
  const VectorXd unit = VectorXd::Ones(1);
  const double final_value = facts.gain;
  double peak = 0.0;
  int settled = 0;
  // A channel without steady-state gain is measured against the largest value it reached.
  const auto bound = [&] {
    return tolerance * (final_value != 0.0 ? std::abs(final_value) : peak);
  };
  for (int k = 0; k < length; ++k) {
    const double value = channel.output()(0);
    peak = std::max(peak, std::abs(value));
    if (std::abs(value - final_value) > bound()) settled = k + 1;
    channel.advance(unit);
  }
  return std::min(settled, limit);
}

/// The channel alone, as 0 to 0, without what is not linear about it.
ChannelSpec linear_part(const ChannelSpec& channel, const ModelDefinition& definition) {
  ChannelSpec part = channel;
  part.cv = 0;
  part.input = 0;
  part.input_block.reset();
  if (const auto* tanks = std::get_if<TankChain>(&channel.dynamics))
    part.dynamics = linearised(*tanks, definition.input_origin(channel.input),
                               definition.output_origin(channel.cv));
  return part;
}

}  // namespace

struct LinearModel::State {
  explicit State(const ModelSpec& spec)
      : definition(std::make_shared<const ModelDefinition>(spec)),
        history(definition->spec.input_count + static_cast<int>(definition->own_inputs.size()),
                definition->history),
        states(VectorXd::Zero(definition->state_count)),
        next_states(VectorXd::Zero(definition->state_count)),
        last_input(definition->input_origin),
        fed_back(VectorXd::Zero(static_cast<Index>(definition->own_inputs.size()))),
        fed_back_before(fed_back),
        fir_outputs(VectorXd::Zero(static_cast<Index>(definition->firs.size()))),
        linear_output(VectorXd::Zero(definition->spec.cv_count)),
        output(VectorXd::Zero(definition->spec.cv_count)) {
    for (Index i = 0; i < definition->input_origin.size(); ++i)
      elements.emplace_back(definition->spec.input_blocks[static_cast<std::size_t>(i)],
                            definition->input_origin(i));
    for (const OwnInput& own : definition->own_inputs)
      own_elements.emplace_back(own.block, definition->input_origin(own.input));
  }

  void archive(Archive& a);
  /// What is finite of the inputs; the rest stays as it was.
  void hold(const Eigen::Ref<const VectorXd>& input);
  void compute_output();
  void add_disturbances();
  void read_feedback();
  void rest_own_inputs();
  void set_own_inputs();
  /// Where the input that this element goes with stands, from its operating point; 0 without one.
  [[nodiscard]] double other_deviation(const InputElement& element) const {
    const int other = element.other();
    return other < 0 ? 0.0 : last_input(other) - definition->input_origin(other);
  }
  [[nodiscard]] double time_s() const {
    return clock_start_s + static_cast<double>(elapsed) * definition->spec.sample_time_s;
  }
  [[nodiscard]] double tolerance_s() const {
    return calibration::model_rounding::kSameInstant * definition->spec.sample_time_s;
  }
  /// What is held before the first sample was given before it.
  [[nodiscard]] double rest_time_s() const {
    return clock_start_s - definition->spec.sample_time_s + tolerance_s();
  }

  std::shared_ptr<const ModelDefinition> definition;  ///< shared by copies
  std::vector<InputElement> elements;
  std::vector<InputElement> own_elements;  ///< one per own input of a channel
  InputHistory history;
  VectorXd states, next_states;
  VectorXd last_input;
  VectorXd fed_back, fed_back_before;  ///< y(k), y(k-1) of the channels with an own input
  VectorXd fir_outputs;                ///< y(k) of each step response, which is long to compute
  double clock_start_s = 0.0;
  std::int64_t elapsed = 0;  ///< samples since then
  VectorXd linear_output, output;
};

/// From the states at k+1 and the inputs up to k.
void LinearModel::State::archive(Archive& a) {
  // not archived: definition (construction)
  // not archived: next_states, linear_output (empty between calls)
  a(elements, own_elements, history, states, last_input, fed_back, fed_back_before, fir_outputs,
    clock_start_s, elapsed, output);
}

void LinearModel::State::hold(const Eigen::Ref<const VectorXd>& input) {
  for (Index i = 0; i < last_input.size(); ++i)
    if (std::isfinite(input(i))) last_input(i) = input(i);
}

void LinearModel::State::compute_output() {
  const ModelDefinition& fixed = *definition;
  linear_output.setZero();
  for (const LagChannel& lag : fixed.lags) linear_output(lag.cv) += lag.output(history, states);
  for (const FilterChannel& filter : fixed.filters)
    linear_output(filter.cv) += filter.output(states);
  for (std::size_t i = 0; i < fixed.firs.size(); ++i) {
    const auto at = static_cast<Index>(i);
    fir_outputs(at) = fixed.firs[i].output(history);
    linear_output(fixed.firs[i].cv) += fir_outputs(at);
  }
  for (const TankChannel& tanks : fixed.tanks) linear_output(tanks.cv) += tanks.output(states);
  if (fixed.spec.state_space) {
    linear_output.noalias() += fixed.spec.state_space->c * states;
    for (int input = 0; input < fixed.spec.input_count; ++input)
      linear_output += fixed.spec.state_space->d.col(input) * *history.newest(input);
  }
  if (!fixed.spec.disturbances.empty()) add_disturbances();
  for (Index cv = 0; cv < output.size(); ++cv)
    output(cv) = apply_output_block(fixed.spec.output_blocks[static_cast<std::size_t>(cv)],
                                    fixed.output_origin(cv), linear_output(cv));
}

void LinearModel::State::add_disturbances() {
  const double now_s = time_s();
  for (const DisturbanceTerm& disturbance : definition->spec.disturbances)
    linear_output(disturbance.cv) += disturbance_at(disturbance, now_s, tolerance_s());
}

/// y(k), before the inputs move on.
void LinearModel::State::read_feedback() {
  for (std::size_t i = 0; i < definition->own_inputs.size(); ++i) {
    const auto at = static_cast<Index>(i);
    fed_back_before(at) = fed_back(at);
    fed_back(at) = definition->output_of(definition->own_inputs[i], history, states, fir_outputs);
  }
}

/// u(k) through the input's own element, then the channel's, less what is fed back.
void LinearModel::State::set_own_inputs() {
  for (std::size_t i = 0; i < definition->own_inputs.size(); ++i) {
    const OwnInput& own = definition->own_inputs[i];
    const auto at = static_cast<Index>(i);
    double deviation = *history.newest(own.input);
    if (own.block)
      deviation = own_elements[i].apply(deviation + definition->input_origin(own.input),
                                        time_s() + tolerance_s(), other_deviation(own_elements[i]));
    if (own.feedback) deviation -= own.feedback->value(fed_back(at), fed_back_before(at));
    history.set_newest(own.source, deviation);
  }
}

void LinearModel::State::rest_own_inputs() {
  for (std::size_t i = 0; i < definition->own_inputs.size(); ++i) {
    const OwnInput& own = definition->own_inputs[i];
    const auto at = static_cast<Index>(i);
    double deviation = *history.newest(own.input);
    if (own.block) {
      const double input = deviation + definition->input_origin(own.input);
      own_elements[i].reset(input);
      deviation = own_elements[i].apply(input, rest_time_s(), other_deviation(own_elements[i]));
    }
    if (own.feedback) {
      const double rest = own.feedback->rest(deviation);
      fed_back(at) = rest;
      deviation -= own.feedback->value(rest, rest);
    }
    history.fill(own.source, deviation);
  }
}

LinearModel::LinearModel(const ModelSpec& spec) : state_(std::make_unique<State>(spec)) { reset(); }
LinearModel::LinearModel(LinearModel&&) noexcept = default;
LinearModel& LinearModel::operator=(LinearModel&&) noexcept = default;
LinearModel::LinearModel(const LinearModel& other)
    : state_(std::make_unique<State>(*other.state_)) {}
LinearModel& LinearModel::operator=(const LinearModel& other) {
  if (this != &other) *state_ = *other.state_;
  return *this;
}
LinearModel::~LinearModel() = default;

void LinearModel::archive(Archive& a) { state_->archive(a); }

int LinearModel::input_count() const { return state_->definition->spec.input_count; }
int LinearModel::cv_count() const { return state_->definition->spec.cv_count; }

const VectorXd& LinearModel::operating_input() const { return state_->definition->input_origin; }

void LinearModel::reset() {
  reset_steady(state_->definition->input_origin);
  const std::optional<StateSpaceSpec>& system = state_->definition->spec.state_space;
  if (!system) return;
  if (system->x0.size() != 0)
    state_->states = system->x0;
  else
    state_->states.setZero();
  state_->compute_output();
}

void LinearModel::reset_steady(const Eigen::Ref<const VectorXd>& input) {
  State& state = *state_;
  const ModelDefinition& fixed = *state.definition;
  state.states.setZero();
  state.hold(input);
  for (int i = 0; i < fixed.spec.input_count; ++i) {
    InputElement& element = state.elements[static_cast<std::size_t>(i)];
    element.reset(state.last_input(i));
    const double deviation =
        element.apply(state.last_input(i), state.rest_time_s(), state.other_deviation(element));
    state.history.fill(i, deviation);
    if (fixed.state_space) state.states += fixed.state_space->rest.col(i) * deviation;
  }
  state.rest_own_inputs();
  for (const LagChannel& lag : fixed.lags)
    state.states.segment(lag.first_state, lag.rest.size()) =
        lag.rest * *state.history.newest(lag.source);
  for (const FilterChannel& filter : fixed.filters)
    state.states.segment(filter.first_state, filter.rest.size()) =
        filter.rest * *state.history.newest(filter.source);
  for (const TankChannel& tanks : fixed.tanks) tanks.rest(state.history, state.states);
  state.elapsed = 0;
  state.compute_output();
}

void LinearModel::set_time_s(double time_s) {
  state_->clock_start_s = time_s;
  state_->elapsed = 0;
  if (!state_->definition->spec.disturbances.empty()) state_->compute_output();
}

const VectorXd& LinearModel::output() const { return state_->output; }

void LinearModel::advance(const Eigen::Ref<const VectorXd>& input) {
  State& state = *state_;
  const ModelDefinition& fixed = *state.definition;
  if (!fixed.own_inputs.empty()) state.read_feedback();
  state.history.next();
  state.hold(input);
  for (int i = 0; i < fixed.spec.input_count; ++i) {
    InputElement& element = state.elements[static_cast<std::size_t>(i)];
    const double deviation = element.apply(
        state.last_input(i), state.time_s() + state.tolerance_s(), state.other_deviation(element));
    state.history.set_newest(i, deviation);
  }
  if (!fixed.own_inputs.empty()) state.set_own_inputs();
  for (const LagChannel& lag : fixed.lags) lag.step(state.history, state.states);
  for (const FilterChannel& filter : fixed.filters) filter.step(state.history, state.states);
  for (const TankChannel& tanks : fixed.tanks) tanks.step(state.history, state.states);
  if (fixed.spec.state_space) {
    state.next_states.noalias() = fixed.spec.state_space->a * state.states;
    for (int i = 0; i < fixed.spec.input_count; ++i)
      state.next_states += fixed.spec.state_space->b.col(i) * *state.history.newest(i);
    state.states.swap(state.next_states);
  }
  ++state.elapsed;
  state.compute_output();
}

VectorXd LinearModel::impulse_response(int cv, int input, int length) const {
  VectorXd response = VectorXd::Zero(std::max(0, length));
  if (!state_->definition->fact(cv, input).exists) return response;
  LinearModel one = channel(cv, input);
  VectorXd pulse = VectorXd::Ones(1);
  for (Index k = 0; k < response.size(); ++k) {
    response(k) = one.output()(0);
    one.advance(pulse);
    pulse.setZero();
  }
  return response;
}

MatrixXd LinearModel::steady_gain() const {
  MatrixXd gain(cv_count(), input_count());
  for (int cv = 0; cv < cv_count(); ++cv)
    for (int input = 0; input < input_count(); ++input)
      gain(cv, input) = state_->definition->fact(cv, input).gain;
  return gain;
}

BoolMatrix LinearModel::integrating() const {
  BoolMatrix result(cv_count(), input_count());
  for (int cv = 0; cv < cv_count(); ++cv)
    for (int input = 0; input < input_count(); ++input)
      result(cv, input) = state_->definition->fact(cv, input).integrating;
  return result;
}

int LinearModel::settling_samples(double tolerance, int limit) const {
  int samples = 0;
  for (int cv = 0; cv < cv_count(); ++cv) {
    for (int input = 0; input < input_count(); ++input) {
      const ChannelFacts& facts = state_->definition->fact(cv, input);
      if (!facts.exists || facts.integrating) continue;
      LinearModel one = channel(cv, input);
      samples = std::max(samples, settling_of(one, facts, tolerance, limit));
    }
  }
  return samples;
}

double LinearModel::time_constant_samples(int cv, int input) const {
  return state_->definition->fact(cv, input).slowest;
}

double LinearModel::slowest_time_constant_samples() const {
  double slowest = 1.0;
  for (const ChannelFacts& facts : state_->definition->facts)
    slowest = std::max(slowest, facts.slowest);
  return slowest;
}

double LinearModel::longest_dead_time_samples() const {
  double longest = 0.0;
  for (const ChannelFacts& facts : state_->definition->facts)
    longest = std::max(longest, facts.dead_time);
  return longest;
}

LinearModel LinearModel::channel(int cv, int input) const {
  const ModelSpec& spec = state_->definition->spec;
  ModelSpec one;
  one.sample_time_s = spec.sample_time_s;
  one.input_count = 1;
  one.cv_count = 1;
  if (spec.state_space)
    one.state_space = StateSpaceSpec{spec.state_space->a,
                                     spec.state_space->b.col(input),
                                     spec.state_space->c.row(cv),
                                     spec.state_space->d.block(cv, input, 1, 1),
                                     {}};
  else if (const ChannelSpec* channel = state_->definition->channel(cv, input))
    one.channels.push_back(linear_part(*channel, *state_->definition));
  return LinearModel(one);
}

}  // namespace mpm
