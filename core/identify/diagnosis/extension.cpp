#include "core/identify/diagnosis/extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/identify/causes/square_waves.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// A 95 % interval is so many s.d. wide to either side: the noise model is fitted too, so a little
/// more than 1.96.
constexpr double kReach = 2.05;

/// Where an effect's coordinates begin in the covariance of a fit with all effects free.
Index first_coordinate(const Fit& fit, std::size_t effect) {
  Index first = 0;
  for (std::size_t e = 0; e < effect; ++e)
    first += static_cast<Index>(fit.effects[e].coordinates.size());
  return first;
}

Parameter shown(const Coordinate& c, double sd, double sample_time_s) {
  const double low = c.value - kReach * sd, high = c.value + kReach * sd;
  if (c.name.rfind("log_", 0) == 0)
    return {c.name.substr(4), std::exp(c.value), std::exp(low), std::exp(high)};
  if (c.name == "dead_time_samples")
    return {"dead_time_error", c.value * sample_time_s, low * sample_time_s, high * sample_time_s};
  return {c.name, c.value, low, high};
}

}  // namespace

Finding to_finding(const SearchResult& found, std::size_t index, const Problem& problem) {
  const Named& named = found.named[index];
  const Fit& fit = found.fit;
  Finding finding;
  const Effect& effect = named.effect;
  finding.subject = effect.subject;
  finding.evidence = named.evidence;
  finding.confidence = named.confidence;
  finding.rivals = named.rivals;
  const double sample_time = problem.surroundings().sample_time_s;
  const Index first = first_coordinate(fit, index);
  for (std::size_t i = 0; i < effect.coordinates.size(); ++i) {
    const Index at = first + static_cast<Index>(i);
    const double sd = std::sqrt(std::max(0.0, fit.covariance(at, at)));
    finding.parameters.push_back(shown(effect.coordinates[i], sd, sample_time));
  }
  const double onset_s =
      problem.surroundings().start_s + static_cast<double>(effect.onset) * sample_time;
  if (effect.onset > 0) finding.onset_s = onset_s;
  if (effect.subject.cause == Cause::kUnmodelledInput)
    for (Parameter& parameter : finding.parameters)
      if (parameter.name == "dead_time_error") parameter.name = "dead_time";
  if (effect.subject.cause == Cause::kOutputDisturbance) {
    if (is_square_wave(effect)) {
      finding.parameters.erase(finding.parameters.begin() + 1);  // where in its period it begins
      Parameter& size = finding.parameters[0];
      if (size.value < 0.0) size = {"size", -size.value, -size.high, -size.low};
    } else if (effect.subject.kind == "periodic") {
      const double sine = effect.value("sine", 0.0), cosine = effect.value("cosine", 0.0);
      const double size = std::hypot(sine, cosine);
      const double reach =
          size > 0.0 ? finding.parameters[0].high - finding.parameters[0].value : 0.0;
      Parameter frequency = finding.parameters.back();
      finding.parameters = {
          {"size", size, size - reach, size + reach},
          {"period", 1.0 / frequency.value, 1.0 / frequency.high, 1.0 / frequency.low}};
    } else if (effect.subject.kind == "drift") {
      // What it has come to by the end of the data that were fitted.
      const double length = static_cast<double>(problem.samples() - effect.onset) * sample_time;
      Parameter size = finding.parameters[0];
      size = {"size", size.value * length, size.low * length, size.high * length};
      finding.parameters.insert(finding.parameters.begin(), size);
      finding.onset_s = onset_s;
    } else if (effect.onset > 0) {
      finding.onset_s = onset_s;
    }
  }
  return finding;
}

ModelSpec extend(const Problem& problem, const SearchResult& found, const std::vector<bool>& in,
                 const std::vector<bool>& keep) {
  ModelSpec model = problem.model();
  std::vector<bool> touched(keep.size(), false);
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    if (!in[i]) continue;
    const Effect& effect = found.named[i].effect;
    for (int cv = 0; cv < model.cv_count; ++cv)
      if (touches(effect, model, cv)) touched[static_cast<std::size_t>(cv)] = true;
    apply(effect, problem.surroundings(), model);
  }
  for (const CvFit& fit : found.fit.cvs) {
    const auto j = static_cast<std::size_t>(fit.cv);
    if (!touched[j] || !keep[j]) continue;
    const CvData& data = problem.data(fit.cv);
    // The level is the first nuisance.
    model.output_origin(fit.cv) += data.nuisances(0, 0) * fit.beta(0);
    for (ChannelSpec& channel : model.channels) {
      if (channel.cv != fit.cv) continue;
      ChannelError error;
      for (std::size_t b = 0; b < data.meaning.size(); ++b) {
        if (data.meaning[b].input != channel.input) continue;
        const double value = data.meaning[b].sd * fit.beta(static_cast<Index>(b));
        if (std::strcmp(data.meaning[b].coordinate, "gain_ratio") == 0)
          error.gain_ratio += value;
        else if (std::strcmp(data.meaning[b].coordinate, "log_time_constant_ratio") == 0)
          error.time_constant_ratio = std::exp(value);
        else
          error.dead_time_error_s = value * model.sample_time_s;
      }
      channel = edited(channel, error, model.sample_time_s);
    }
  }
  return model;
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
