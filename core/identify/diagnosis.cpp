#include "core/identify/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/channel_edit.hpp"
#include "core/identify/extension.hpp"
#include "core/identify/noise_change.hpp"
#include "core/identify/problem.hpp"
#include "core/identify/search.hpp"
#include "core/identify/validation.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kNoiseOrder = 8;
/// s.d. of a relative gain error beyond which the data cannot tell a good model from a bad one.
constexpr double kVisible = 0.25;

Recording part(const Recording& recording, Index first, Index count) {
  Recording result;
  result.sample_time_s = recording.sample_time_s;
  result.start_s = recording.start_s + static_cast<double>(first) * recording.sample_time_s;
  result.inputs = recording.inputs.middleRows(first, count);
  result.cvs = recording.cvs.middleRows(first, count);
  if (recording.aux.cols() > 0)
    result.aux = recording.aux.middleRows(first, count);
  else
    result.aux.resize(count, 0);
  return result;
}

double slowest_samples(const ModelSpec& model) {
  double slowest = 1.0;
  for (const ChannelSpec& channel : model.channels)
    slowest = std::max(slowest, slowest_time_constant_s(channel, model.sample_time_s));
  return slowest / model.sample_time_s;
}

/// How far each channel is from the model's, everything else as found.
std::vector<ChannelEstimate> estimate_channels(Problem& problem, const SearchResult& found) {
  std::vector<ChannelEstimate> estimates;
  for (const ChannelSpec& channel : problem.model().channels) {
    if (channel.input >= problem.surroundings().model_inputs) continue;
    Effect effect;
    effect.subject = {Cause::kDynamics, channel.cv, channel.input, -1, ""};
    const double sample_time = problem.surroundings().sample_time_s;
    const double removable = removable_dead_time_s(channel, sample_time) / sample_time;
    effect.coordinates = {{"gain_ratio", 1.0, 1.0, 1.0, 0.01, 0.02, 20.0},
                          {"log_time_constant_ratio", 0.0, 0.0, 0.5, 0.01, -2.5, 2.5},
                          {"dead_time_samples", 0.0, 0.0, 5.0, 0.25, -removable, 60.0}};
    std::vector<Effect> effects;
    for (const Effect& known : found.fit.effects) {
      const Subject& s = known.subject;
      const bool same = s.cv == channel.cv && s.input == channel.input && known.onset == 0 &&
                        known.find("gain_ratio") != nullptr;
      if (!same &&
          !(s.cause == Cause::kDeadTime && s.cv == channel.cv && s.input == channel.input) &&
          !(s.cause == Cause::kTimeConstant && s.cv == channel.cv && s.input == channel.input)) {
        effects.push_back(known);
        continue;
      }
      for (Coordinate& coordinate : effect.coordinates)
        coordinate.value = known.value(coordinate.name, coordinate.value);
    }
    effects.push_back(effect);
    const Fit fit = problem.fit(effects, effects.size() - 1, {channel.cv}, 4);
    const auto parameter = [&](const char* name, Index i, double scale, bool log) {
      const double value = fit.effects.back().coordinates[static_cast<std::size_t>(i)].value;
      const double reach = 1.96 * std::sqrt(fit.covariance(i, i));
      const auto shown = [&](double v) { return log ? std::exp(v) : scale * v; };
      return Parameter{name, shown(value), shown(value - reach), shown(value + reach)};
    };
    estimates.push_back({channel.cv, channel.input, parameter("gain_ratio", 0, 1.0, false),
                         parameter("time_constant_ratio", 1, 1.0, true),
                         parameter("dead_time_error", 2, sample_time, false)});
  }
  return estimates;
}

}  // namespace

Index needed_samples(const ModelSpec& model) {
  // Five rows per number that a CV's fit has, in the part that is fitted.
  Index most = 0;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const auto channels = std::count_if(model.channels.begin(), model.channels.end(),
                                        [cv](const ChannelSpec& c) { return c.cv == cv; });
    most = std::max<Index>(most, model.state_space ? 3 * model.input_count : 3 * channels);
  }
  return 15 * (most + kNoiseOrder + 4) / 2;
}

Diagnosis diagnose(const ModelSpec& given, const Recording& recording, const Recording* validation,
                   const DiagnosisSettings& settings) {
  Diagnosis diagnosis;
  diagnosis.samples = recording.samples();
  diagnosis.fit_samples =
      validation
          ? recording.samples()
          : static_cast<Index>(settings.fit_share * static_cast<double>(recording.samples()));
  diagnosis.validation_samples =
      validation ? validation->samples() : recording.samples() - diagnosis.fit_samples;
  diagnosis.extended = given;

  const ModelSpec base = in_channels(given);
  const ModelSpec model = with_aux_inputs(base, recording);
  const Recording fitted = part(recording, 0, diagnosis.fit_samples);
  Problem problem(model, base.input_count, fitted, Tolerances{}, kNoiseOrder);
  SearchSettings search_settings;
  search_settings.max_findings = settings.max_findings;
  search_settings.progress = settings.progress;
  const SearchResult found = search(problem, search_settings);

  for (const Named& named : found.named)
    diagnosis.findings.push_back(to_finding(named, found.fit, problem));
  for (const CvFit& fit : found.fit.cvs) {
    const std::optional<NoiseChange> change = find_noise_change(fit, problem.data(fit.cv));
    if (!change) continue;
    Finding finding;
    finding.subject = {Cause::kNoise, fit.cv, -1, -1, ""};
    finding.parameters = {{"variance_ratio", change->ratio, change->low, change->high}};
    finding.evidence = change->z * change->z;
    finding.confidence = 0.99;
    finding.onset_s = fitted.start_s + static_cast<double>(change->onset) * fitted.sample_time_s;
    diagnosis.findings.push_back(std::move(finding));
  }
  std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.evidence > b.evidence; });
  diagnosis.channels = estimate_channels(problem, found);

  // The gain, on what no fit has seen.
  const Recording& unseen = validation ? *validation : recording;
  const Index first = validation ? 0 : diagnosis.fit_samples;
  Simulator all(recording), other(unseen);
  diagnosis.before = all.all(model);
  if (validation) diagnosis.validation_before = other.all(model);
  const MatrixXd& before = validation ? diagnosis.validation_before : diagnosis.before;
  std::vector<bool> keep(static_cast<std::size_t>(model.cv_count), true);
  const Index block = static_cast<Index>(2.0 * slowest_samples(model)) + 10;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const ModelSpec extended = extend(problem, found, keep);
    diagnosis.after = all.all(extended);
    if (validation) diagnosis.validation_after = other.all(extended);
    const MatrixXd& after = validation ? diagnosis.validation_after : diagnosis.after;
    diagnosis.scores.clear();
    bool refused = false;
    for (int cv = 0; cv < model.cv_count; ++cv) {
      const auto j = static_cast<std::size_t>(cv);
      CvScore result =
          score(unseen.cvs.col(cv).tail(unseen.samples() - first),
                before.col(cv).tail(unseen.samples() - first),
                after.col(cv).tail(unseen.samples() - first), block, settings.seed + j);
      result.refused = !keep[j];
      const bool changed = after.col(cv) != before.col(cv);
      if (keep[j] && changed && !(result.gain_low > 0.0)) {
        keep[j] = false;
        refused = true;
      }
      diagnosis.scores.push_back(result);
    }
    diagnosis.extended = finish(extended, base, diagnosis.new_inputs);
    if (!refused) break;
  }
  if (found.named.empty()) diagnosis.extended = given;

  if (!diagnosis.findings.empty()) {
    diagnosis.verdict = DiagnosisVerdict::kMismatch;
    return diagnosis;
  }
  diagnosis.verdict = DiagnosisVerdict::kMatch;
  for (const ChannelEstimate& estimate : diagnosis.channels)
    if (estimate.gain_ratio.high - estimate.gain_ratio.low > 2.0 * 1.96 * kVisible)
      diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  return diagnosis;
}

}  // namespace mpm
