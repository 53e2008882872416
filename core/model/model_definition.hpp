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
#include "core/model/state_feedback.hpp"
#include "core/model/state_space.hpp"
#include "core/model/tank_channel.hpp"

namespace mpm {

/// What the dynamics of one channel see in place of the input itself: a row of the input history of
/// their own.
struct OwnInput {
  int input;   ///< of the model
  int source;  ///< row of the input history
  std::optional<InputBlock> block;
  std::optional<StateFeedback> feedback;
  std::size_t form, place;  ///< of the dynamics whose output is fed back: which list, where in it
};

/// A checked `ModelSpec` with everything that does not change while the model runs.
struct ModelDefinition {
  /// Throws std::invalid_argument where the specification makes no sense.
  explicit ModelDefinition(ModelSpec given);
  ModelDefinition(const ModelDefinition&) = delete;  // `channels` point into it
  ModelDefinition& operator=(const ModelDefinition&) = delete;

  ModelSpec spec;
  Eigen::VectorXd input_origin, output_origin;
  std::vector<LagChannel> lags;
  std::vector<FilterChannel> filters;
  std::vector<FirChannel> firs;
  std::vector<TankChannel> tanks;
  std::vector<OwnInput> own_inputs;
  std::optional<StateSpaceFacts> state_space;
  std::vector<ChannelFacts> facts;           ///< cv_count x input_count, row by row
  std::vector<const ChannelSpec*> channels;  ///< of `spec`, likewise; null where there is none
  Eigen::Index state_count = 0;
  int history = 1;  ///< input values that the channels look back on

  [[nodiscard]] const ChannelFacts& fact(int cv, int input) const {
    return facts[place(cv, input)];
  }
  [[nodiscard]] const ChannelSpec* channel(int cv, int input) const {
    return channels[place(cv, input)];
  }
  /// Deviation of the CV that the one channel behind `own` makes up; `fir_outputs`: those of
  /// `firs`.
  [[nodiscard]] double output_of(const OwnInput& own, const InputHistory& inputs,
                                 const Eigen::VectorXd& states,
                                 const Eigen::VectorXd& fir_outputs) const;

 private:
  [[nodiscard]] std::size_t place(int cv, int input) const {
    return static_cast<std::size_t>(cv * spec.input_count + input);
  }
  void add_channel(const ChannelSpec& channel);
  void check_block(const std::optional<InputBlock>& block, int input) const;
  void check_terms() const;
  ChannelFacts add(const ChannelSpec& channel, int source, const TransferFunction& transfer);
  ChannelFacts add(const ChannelSpec& channel, int source, const DiscreteFilter& filter);
  ChannelFacts add(const ChannelSpec& channel, int source, const StepResponse& response);
  ChannelFacts add(const ChannelSpec& channel, int source, const TankChain& tanks);
};

}  // namespace mpm
