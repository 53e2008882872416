#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/model/channel_facts.hpp"
#include "core/model/filter_channel.hpp"
#include "core/model/fir_channel.hpp"
#include "core/model/lag_channel.hpp"
#include "core/model/model_spec.hpp"
#include "core/model/state_space.hpp"

namespace mpm {

/// A checked `ModelSpec` with everything that does not change while the model runs.
struct ModelDefinition {
  /// Throws std::invalid_argument where the specification makes no sense.
  explicit ModelDefinition(ModelSpec given);

  ModelSpec spec;
  Eigen::VectorXd input_origin, output_origin;
  std::vector<LagChannel> lags;
  std::vector<FilterChannel> filters;
  std::vector<FirChannel> firs;
  std::optional<StateSpaceFacts> state_space;
  std::vector<ChannelFacts> facts;  ///< cv_count x input_count, row by row
  Eigen::Index state_count = 0;
  int history = 1;  ///< input values that the channels look back on

  [[nodiscard]] const ChannelFacts& fact(int cv, int input) const {
    return facts[static_cast<std::size_t>(cv * spec.input_count + input)];
  }

 private:
  ChannelFacts add(const ChannelSpec& channel, const TransferFunction& transfer);
  ChannelFacts add(const ChannelSpec& channel, const DiscreteFilter& filter);
  ChannelFacts add(const ChannelSpec& channel, const StepResponse& response);
  ChannelFacts add(const ChannelSpec& channel, const TankChain& tanks);
};

}  // namespace mpm
