#include "core/identify/diagnosis/extension.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;

ModelSpec extend(const Problem& problem, const SearchResult& found, const std::vector<bool>& in,
                 const std::vector<bool>& keep, const OpenChannels& open, Index at) {
  return extend(problem.model(), problem, found, in, keep, open, at);
}

ModelSpec extend(ModelSpec model, const Problem& problem, const SearchResult& found,
                 const std::vector<bool>& in, const std::vector<bool>& keep,
                 const OpenChannels& open, Index at) {
  std::vector<bool> touched(keep.size(), false), wrong = touched;
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    if (!in[i]) continue;
    const Effect& effect = found.named[i].effect;
    for (int cv = 0; cv < model.cv_count; ++cv)
      if (touches(effect, model, cv)) {
        touched[static_cast<std::size_t>(cv)] = true;
        if (cause_of(effect).acts_through_channels()) wrong[static_cast<std::size_t>(cv)] = true;
      }
    if (effect.onset <= at || effect.edit->knows_onset())
      apply(effect, problem.surroundings(), model);
  }
  for (const CvFit& fit : found.fit.cvs) {
    const auto j = static_cast<std::size_t>(fit.cv);
    if (!touched[j] || !keep[j]) continue;
    const CvData& data = problem.data(fit.cv);
    model.output_origin(fit.cv) += mean_level(data, fit);
    for (ChannelSpec& channel : model.channels) {
      if (channel.cv != fit.cv) continue;
      if (open && !open(channel.cv, channel.input, wrong[j])) continue;
      ChannelError error;
      for (std::size_t b = 0; b < data.meaning.size(); ++b) {
        if (data.meaning[b].input != channel.input) continue;
        const double value = data.meaning[b].sd * fit.beta(static_cast<Index>(b));
        if (data.meaning[b].quantity == &kGainRatio)
          error.gain_ratio += value;
        else if (data.meaning[b].quantity == &kTimeConstantRatio)
          error.time_constant_ratio = std::exp(value);
        else
          error.dead_time_error_s = value * problem.surroundings().sample_time_s;
      }
      channel = edited(channel, error, model.sample_time_s);
    }
  }
  return model;
}

std::vector<Stage> stages_of(const Problem& problem, const SearchResult& found,
                             const std::vector<bool>& in, const std::vector<bool>& keep,
                             const OpenChannels& open) {
  std::vector<Index> rows = {0};
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    if (in[i] && !effect.edit->knows_onset()) rows.push_back(effect.onset);
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  std::vector<Stage> stages;
  stages.reserve(rows.size());
  for (const Index row : rows) stages.push_back({row, extend(problem, found, in, keep, open, row)});
  return stages;
}

ModelSpec finish(const ModelSpec& extended, const ModelSpec& base, std::vector<int>& used) {
  ModelSpec model = extended;
  used.clear();
  std::vector<int> place(static_cast<std::size_t>(extended.input_count), -1);
  int next = base.input_count;
  for (int input = 0; input < extended.input_count; ++input) {
    const bool needed = input < base.input_count ||
                        std::any_of(extended.channels.begin(), extended.channels.end(),
                                    [input](const ChannelSpec& c) { return c.input == input; });
    if (!needed) continue;
    place[static_cast<std::size_t>(input)] = input < base.input_count ? input : next++;
    if (input >= base.input_count) used.push_back(input - base.input_count);
  }
  model.input_count = next;
  model.input_blocks.assign(static_cast<std::size_t>(next), std::nullopt);
  model.input_origin.resize(next);
  for (int input = 0; input < extended.input_count; ++input) {
    const int to = place[static_cast<std::size_t>(input)];
    if (to < 0) continue;
    model.input_blocks[static_cast<std::size_t>(to)] =
        extended.input_blocks[static_cast<std::size_t>(input)];
    model.input_origin(to) = extended.input_origin(input);
  }
  for (ChannelSpec& channel : model.channels)
    channel.input = place[static_cast<std::size_t>(channel.input)];
  return model;
}

}  // namespace mpm
