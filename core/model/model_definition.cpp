#include "core/model/model_definition.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

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
  for (const ChannelSpec& channel : spec.channels) {
    if (channel.cv < 0 || channel.cv >= spec.cv_count || channel.input < 0 ||
        channel.input >= spec.input_count)
      throw std::invalid_argument("channel: no such CV or input");
    ChannelFacts& slot =
        facts[static_cast<std::size_t>(channel.cv * spec.input_count + channel.input)];
    if (slot.exists) throw std::invalid_argument("channel: given twice");
    slot =
        std::visit([&](const auto& dynamics) { return add(channel, dynamics); }, channel.dynamics);
    slot.exists = true;
  }
}

ChannelFacts ModelDefinition::add(const ChannelSpec&, const TankChain&) {
  throw std::invalid_argument("tanks in series cannot be simulated yet");
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, const TransferFunction& transfer) {
  LagChannel lag = make_lag_channel(channel, transfer, spec.sample_time_s, state_count);
  const ChannelFacts result = facts_of(lag, transfer, spec.sample_time_s);
  state_count += lag.rest.size();
  history = std::max(history, lag.history());
  lags.push_back(std::move(lag));
  return result;
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, const DiscreteFilter& filter) {
  DescribedFilter made = make_filter_channel(channel, filter, state_count);
  state_count += made.channel.rest.size();
  history = std::max(history, made.channel.history());
  filters.push_back(std::move(made.channel));
  return made.facts;
}

ChannelFacts ModelDefinition::add(const ChannelSpec& channel, const StepResponse& response) {
  DescribedFir made = make_fir_channel(channel, response);
  history = std::max(history, made.channel.history());
  firs.push_back(std::move(made.channel));
  return made.facts;
}

}  // namespace mpm
