#include "core/model/model_definition.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/model/disturbance.hpp"
#include "core/model/static_blocks.hpp"

namespace mpm {
namespace {

using Eigen::VectorXd;

VectorXd or_zero(const VectorXd& vector, int size, const char* name) {
  if (vector.size() == 0) return VectorXd::Zero(size);
  if (vector.size() != size || !vector.allFinite())
    throw std::invalid_argument(std::string(name) + ": one finite value per signal expected");
  return vector;
}

}  // namespace

ModelDefinition::ModelDefinition(ModelSpec given) : spec(std::move(given)) {
  if (spec.cv_count < 0 || spec.input_count < 0)
    throw std::invalid_argument("model: negative number of signals");
  input_origin = or_zero(spec.input_origin, spec.input_count, "operating point of the inputs");
  output_origin = or_zero(spec.output_origin, spec.cv_count, "operating point of the CVs");
  const auto inputs = static_cast<std::size_t>(spec.input_count);
  const auto cvs = static_cast<std::size_t>(spec.cv_count);
  if (!spec.input_blocks.empty() && spec.input_blocks.size() != inputs)
    throw std::invalid_argument("input blocks: one entry per input expected");
  if (!spec.output_blocks.empty() && spec.output_blocks.size() != cvs)
    throw std::invalid_argument("output blocks: one entry per CV expected");
  spec.input_blocks.resize(inputs);
  spec.output_blocks.resize(cvs);
  for (const std::optional<OutputBlock>& block : spec.output_blocks)
    if (block) check_output_block(*block);
  for (int i = 0; i < spec.input_count; ++i)
    check_block(spec.input_blocks[static_cast<std::size_t>(i)], i);
  check_terms();

  if (spec.state_space) {
    if (!spec.channels.empty())
      throw std::invalid_argument("model: either channels or a state space, not both");
    check_state_space(*spec.state_space, spec.input_count, spec.cv_count);
    state_space = analyse_state_space(*spec.state_space);
    facts = channel_facts(*spec.state_space, *state_space);
    state_count = spec.state_space->a.rows();
    return;
  }
  facts.resize(cvs * inputs);
  channels.resize(cvs * inputs);
  for (const ChannelSpec& channel : spec.channels) add_channel(channel);
}

void ModelDefinition::check_block(const std::optional<InputBlock>& block, int input) const {
  const auto* product = block ? std::get_if<Product>(&*block) : nullptr;
  if (product == nullptr) return;
  if (product->of < 0 || product->of >= spec.input_count)
    throw std::invalid_argument("product: no such input");
  if (product->of == input)
    throw std::invalid_argument("product: of an input with itself; that is a polynomial");
}

void ModelDefinition::check_terms() const {
  for (const DisturbanceTerm& disturbance : spec.disturbances) {
    if (disturbance.cv < 0 || disturbance.cv >= spec.cv_count)
      throw std::invalid_argument("disturbance: no such CV");
    check_disturbance(disturbance);
  }
  for (const StateTerm& term : spec.state_terms) {
    const auto is_its = [&term](const auto& other) {
      return other.cv == term.cv && other.input == term.input;
    };
    if (std::count_if(spec.state_terms.begin(), spec.state_terms.end(), is_its) > 1)
      throw std::invalid_argument("state term: one per channel at most");
    const auto channel = std::find_if(spec.channels.begin(), spec.channels.end(), is_its);
    if (channel == spec.channels.end()) throw std::invalid_argument("state term: no such channel");
    if (std::holds_alternative<TankChain>(channel->dynamics))
      throw std::invalid_argument("state term: tanks have their own outflow");
  }
}

void ModelDefinition::add_channel(const ChannelSpec& channel) {
  if (channel.cv < 0 || channel.cv >= spec.cv_count || channel.input < 0 ||
      channel.input >= spec.input_count)
    throw std::invalid_argument("channel: no such CV or input");
  ChannelFacts& slot = facts[place(channel.cv, channel.input)];
  if (slot.exists) throw std::invalid_argument("channel: given twice");
  channels[place(channel.cv, channel.input)] = &channel;
  check_block(channel.input_block, channel.input);
  const auto term = std::find_if(spec.state_terms.begin(), spec.state_terms.end(),
                                 [&channel](const StateTerm& each) {
                                   return each.cv == channel.cv && each.input == channel.input;
                                 });
  const bool plain = !channel.input_block && term == spec.state_terms.end();
  const int source = plain ? channel.input : spec.input_count + static_cast<int>(own_inputs.size());
  slot = std::visit([&](const auto& dynamics) { return add(channel, source, dynamics); },
                    channel.dynamics);
  slot.exists = true;
  if (plain) return;
  const std::size_t sizes[] = {lags.size(), filters.size(), firs.size(), tanks.size()};
  const std::size_t form = channel.dynamics.index();
  OwnInput own{channel.input, source, channel.input_block, {}, form, sizes[form] - 1};
  if (term != spec.state_terms.end())
    own.feedback.emplace(term->block, slot, output_origin(channel.cv), spec.sample_time_s);
  own_inputs.push_back(std::move(own));
}

double ModelDefinition::output_of(const OwnInput& own, const InputHistory& inputs,
                                  const VectorXd& states, const VectorXd& fir_outputs) const {
  static_assert(std::is_same_v<decltype(ChannelSpec::dynamics),
                               std::variant<TransferFunction, DiscreteFilter, StepResponse,
                                            TankChain>>);  // `form` counts as this does
  switch (own.form) {
    case 0:
      return lags[own.place].output(inputs, states);
    case 1:
      return filters[own.place].output(states);
    case 2:
      return fir_outputs(static_cast<Eigen::Index>(own.place));
    default:
      return tanks[own.place].output(states);
  }
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, int source,
                                  const TransferFunction& transfer) {
  LagChannel lag = make_lag_channel(channel.cv, source, transfer, spec.sample_time_s, state_count);
  const ChannelFacts result = facts_of(lag, transfer, spec.sample_time_s);
  state_count += lag.rest.size();
  history = std::max(history, lag.history());
  lags.push_back(std::move(lag));
  return result;
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, int source,
                                  const DiscreteFilter& filter) {
  DescribedFilter made = make_filter_channel(channel.cv, source, filter, state_count);
  state_count += made.channel.rest.size();
  history = std::max(history, made.channel.history());
  filters.push_back(std::move(made.channel));
  return made.facts;
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, int source,
                                  const StepResponse& response) {
  DescribedFir made = make_fir_channel(channel.cv, source, response);
  history = std::max(history, made.channel.history());
  firs.push_back(std::move(made.channel));
  return made.facts;
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, int source, const TankChain& chain) {
  DescribedTanks made =
      make_tank_channel(channel.cv, source, chain, input_origin(channel.input),
                        output_origin(channel.cv), spec.sample_time_s, state_count);
  state_count += static_cast<Eigen::Index>(made.channel.tanks.size());
  history = std::max(history, made.channel.history());
  tanks.push_back(std::move(made.channel));
  return made.facts;
}

}  // namespace mpm
