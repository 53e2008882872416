#include "core/identify/causes/unnamed_channel.hpp"

#include <cmath>

#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Quantity kPart{"part", Form::kPlain, Unit::kNone};
constexpr double kUnnamedChannelStep = 0.1;  ///< s.d.
constexpr double kMostParts = 1e3;           ///< of the channel's own response

}  // namespace

ActiveChannel::ActiveChannel(const Problem& problem, const ModelSpec& model,
                             const ChannelSpec& spec)
    : model_(model), spec_(spec), borders_(problem.recording().borders) {
  const auto input = problem.recording().inputs.col(spec.input);
  moves_.resize(input.size());
  double last = model.input_origin(spec.input);
  for (Index k = 0; k < input.size(); ++k) {
    if (std::isfinite(input(k))) last = input(k);
    moves_(k) = last - model.input_origin(spec.input);
  }
  response_ = response_to(moves_);
}

VectorXd ActiveChannel::response_to(const VectorXd& moves) const {
  const Recording driven{
      0.0,     model_.sample_time_s, moves, VectorXd::Zero(moves.size()), MatrixXd(moves.size(), 0),
      borders_};
  Simulator simulator(driven);
  return simulator.cv(alone(spec_, model_.sample_time_s), 0);
}

void UnnamedBehaviour::propose(const Outlook& outlook, std::vector<Effect>& found) const {
  ModelSpec model = outlook.model();
  for (const Effect& effect : outlook.accepted)
    if (effect.onset == 0) mpm::apply(effect, outlook.problem.surroundings(), model);
  for (const CvFit& without : outlook.without)
    for (const ChannelSpec& spec : model.channels) {
      if (spec.cv != without.cv || spec.input >= outlook.inputs()) continue;
      const ActiveChannel channel(outlook.problem, model, spec);
      if (channel.response().allFinite()) propose_for(channel, outlook, without, found);
    }
}

bool UnnamedBehaviour::goes_with(const Effect& accepted, const Effect& mine) const {
  return subject_of(accepted) != subject_of(mine);
}

double UnnamedBehaviour::rarity() const { return kUnnamedRarity; }

Effect UnnamedBehaviour::shaped(const ActiveChannel& channel, const std::vector<VectorXd>& columns,
                                double sd, double picked_from) const {
  const auto samples = columns.front().size();
  auto shape = std::make_shared<MatrixXd>(samples, static_cast<Index>(columns.size()));
  std::vector<Coordinate> coordinates;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    shape->col(static_cast<Index>(i)) = columns[i];
    coordinates.push_back({.quantity = &kPart,
                           .prior_sd = sd,
                           .step = kUnnamedChannelStep * sd,
                           .low = -kMostParts,
                           .high = kMostParts,
                           .number = static_cast<int>(i) + 1});
  }
  Effect found = effect(place_of(channel.spec()), std::move(coordinates),
                        picked_from + cost_of(channel.model().channels.size()));
  found.shape = std::move(shape);
  return found;
}

}  // namespace mpm
