#pragma once

#include <string>
#include <vector>

#include "core/identify/causes/cause.hpp"

namespace mpm {

inline constexpr CauseName kUnnamed{"unnamed", "Without a name"};

/// A channel with all that was accepted, and what it gives its CV on the samples of the problem.
class ActiveChannel {
 public:
  /// All must outlive it.
  ActiveChannel(const Problem& problem, const ModelSpec& model, const ChannelSpec& spec);

  [[nodiscard]] const ChannelSpec& spec() const { return spec_; }
  [[nodiscard]] const ModelSpec& model() const { return model_; }
  [[nodiscard]] const Eigen::VectorXd& response() const { return response_; }

 private:
  [[nodiscard]] Eigen::VectorXd response_to(const Eigen::VectorXd& moves) const;

  const ModelSpec& model_;
  const ChannelSpec& spec_;
  std::vector<Border> borders_;
  Eigen::VectorXd moves_, response_;
};

/// What a channel may do that no cause of the contract means. Such an effect competes with all
/// others, so that what has no name is not given the name of whatever comes nearest; it repairs
/// nothing and is never a finding.
class UnnamedBehaviour : public Cause {
 public:
  explicit UnnamedBehaviour(const char* manner) : Cause(kUnnamed, manner) {}
  void apply(const Effect&, const Surroundings&, ModelSpec&) const override {}
  void propose(const Outlook& outlook, std::vector<Effect>& found) const override;
  [[nodiscard]] bool goes_with(const Effect& accepted, const Effect& mine) const override;
  [[nodiscard]] double rarity() const override;
  /// It is of second order in the input's moves, which a test of the linear channel hardly sees.
  [[nodiscard]] bool acts_through_channels() const override { return false; }

 protected:
  virtual void propose_for(const ActiveChannel& channel, const Outlook& outlook,
                           const CvFit& without, std::vector<Effect>& found) const = 0;
  /// What the CV does per unit of each number, s.d. of the numbers, and 2 ln of what it was picked
  /// from within its channel.
  [[nodiscard]] Effect shaped(const ActiveChannel& channel,
                              const std::vector<Eigen::VectorXd>& columns, double sd,
                              double picked_from) const;
};

}  // namespace mpm
