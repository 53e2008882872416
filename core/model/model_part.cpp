#include "core/model/model_part.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/model/calibration.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

template <class Item>
std::vector<Item> items_of(const std::vector<Item>& all, const std::vector<int>& cvs) {
  std::vector<Item> some;
  for (const Item& item : all) {
    const auto found = std::lower_bound(cvs.begin(), cvs.end(), item.cv);
    if (found == cvs.end() || *found != item.cv) continue;
    some.push_back(item);
    some.back().cv = static_cast<int>(found - cvs.begin());
  }
  return some;
}

bool in_samples(const ChannelSpec& channel) {
  return std::holds_alternative<DiscreteFilter>(channel.dynamics) ||
         std::holds_alternative<StepResponse>(channel.dynamics);
}

/// What a step does, from one cycle to the next as far as the pulse is given; between two samples a
/// straight line.
StepResponse at_cycles(const Eigen::VectorXd& pulse, double cycle) {
  StepResponse step;
  double reached = 0.0;
  Eigen::Index next = 1;  // whose pulse has not been added
  const auto cycles = static_cast<int>(std::ceil(static_cast<double>(pulse.size() - 1) / cycle));
  for (int n = 0; n < cycles; ++n) {
    const double at = n * cycle;
    const auto before = static_cast<Eigen::Index>(at);
    for (; next <= before; ++next) reached += pulse(next);
    step.values.push_back(reached + (at - std::floor(at)) * pulse(before + 1));
  }
  return step;
}

}  // namespace

ModelSpec of_cvs(const ModelSpec& model, const std::vector<int>& cvs) {
  ModelSpec part = model;
  part.cv_count = static_cast<int>(cvs.size());
  part.channels = items_of(model.channels, cvs);
  part.state_terms = items_of(model.state_terms, cvs);
  part.disturbances = items_of(model.disturbances, cvs);
  part.output_blocks.clear();
  part.output_origin.resize(part.cv_count);
  for (std::size_t i = 0; i < cvs.size(); ++i) {
    part.output_blocks.push_back(model.output_blocks[static_cast<std::size_t>(cvs[i])]);
    part.output_origin(static_cast<Eigen::Index>(i)) = model.output_origin(cvs[i]);
  }
  return part;
}

std::optional<ModelSpec> at_longer_sample_time(const ModelSpec& model, const std::vector<int>& cvs,
                                               double cycle) {
  ModelSpec part = of_cvs(model, cvs);
  part.sample_time_s *= cycle;
  part.state_space.reset();
  std::vector<std::pair<int, int>> sampled;  // CV of the part, input
  for (int cv = 0; model.state_space && cv < part.cv_count; ++cv)
    for (int input = 0; input < model.input_count; ++input) sampled.emplace_back(cv, input);
  for (const ChannelSpec& channel : part.channels)
    if (in_samples(channel)) sampled.emplace_back(channel.cv, channel.input);
  if (sampled.empty()) return part;

  const LinearModel fine(model);
  constexpr int kMost = calibration::longer_sample_time::kMostSamples;
  for (const auto& [place, input] : sampled) {
    const int cv = cvs[static_cast<std::size_t>(place)];
    const auto is_it = [cv = place, input = input](const ChannelSpec& one) {
      return one.cv == cv && one.input == input;
    };
    const int settled =
        fine.channel(cv, input).settling_samples(calibration::longer_sample_time::kSettled, kMost);
    if (settled >= kMost || fine.integrating()(cv, input)) return std::nullopt;
    const Eigen::VectorXd pulse =
        fine.impulse_response(cv, input, settled + static_cast<int>(std::ceil(cycle)) + 2);
    if ((pulse.array() == 0.0).all()) {
      std::erase_if(part.channels, is_it);
      continue;
    }
    const auto same = std::find_if(part.channels.begin(), part.channels.end(), is_it);
    if (same != part.channels.end())
      same->dynamics = at_cycles(pulse, cycle);
    else
      part.channels.push_back({place, input, at_cycles(pulse, cycle)});
  }
  return part;
}

}  // namespace mpm
