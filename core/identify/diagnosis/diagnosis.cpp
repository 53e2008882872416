#include "core/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/identify/causes/noise_change.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/measured_gain.hpp"
#include "core/identify/diagnosis/validation.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/initial_state.hpp"
#include "core/identify/fit/problem.hpp"
#include "core/identify/search/search.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kNoiseOrder = 8;
/// s.d. of a relative gain error beyond which the data cannot tell a good model from a bad one.
constexpr double kVisible = 0.25;
/// Innovations below this share of the residual's variance: no noise is so smooth.
constexpr double kSmooth = 0.005;
/// Of a first-order noise model that leaves structure alone.
constexpr double kBound = 0.9;
/// By so much must the log of its free run's mean square error be less.
constexpr double kClear = 0.3;
/// By so much where the free one explains nothing.
constexpr double kSome = 0.1;
/// 2 ln odds of a finding that leaves the verdict open even if it does not carry over.
constexpr double kStrong = 30.0;

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

/// Thrown where the caller's `progress` says so; ends all loops at once.
struct GivenUp {};

std::function<bool(double)> or_give_up(const std::function<bool(double)>& progress) {
  return [&progress](double share) {
    if (progress && !progress(share)) throw GivenUp();
    return true;
  };
}

/// How far each channel is from the model's, everything else as found.
std::vector<ChannelEstimate> estimate_channels(Problem& problem, const SearchResult& found,
                                               const DiagnosisSettings& settings) {
  std::vector<ChannelEstimate> estimates;
  for (const ChannelSpec& channel : problem.model().channels) {
    settings.progress(kSearched);
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

struct Explained {
  std::unique_ptr<Problem> problem;
  SearchResult found;
};

Explained explain_with(const NoiseModel& noise, const ModelSpec& model, int model_inputs,
                       const Recording& recording, const SearchSettings& settings) {
  Explained explained;
  explained.problem =
      std::make_unique<Problem>(model, model_inputs, recording, Tolerances{}, noise);
  explained.found = search(*explained.problem, settings);
  return explained;
}

/// Sum over the CVs of the log of the free run's error on the rows from `first` on.
double log_error(const Explained& explained, const Recording& recording, Index first) {
  const std::vector<bool> all(explained.found.named.size(), true);
  const std::vector<bool> keep(static_cast<std::size_t>(recording.cvs.cols()), true);
  const ModelSpec model = extend(*explained.problem, explained.found, all, keep);
  Simulator simulator(recording);
  double sum = 0.0;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const VectorXd errors =
        (recording.cvs.col(cv) - free_run(simulator, model, cv)).tail(recording.samples() - first);
    const double error = mean_of_finite(errors.cwiseAbs2());
    sum += std::isfinite(error) ? std::log(error) : 1e6;
  }
  return sum;
}

/// Innovations far smaller than what is left: no noise is so smooth.
bool is_smooth(const Explained& explained) {
  return std::any_of(
      explained.found.fit.cvs.begin(), explained.found.fit.cvs.end(), [&](const CvFit& fit) {
        const CvData& data = explained.problem->data(fit.cv);
        const double all = fit.residual.squaredNorm() / std::max(1.0, data.known.sum());
        return fit.variance < kSmooth * all;
      });
}

/// How many gains the data do not tell, so that a match would mean nothing.
std::ptrdiff_t unknown_gains(const std::vector<ChannelEstimate>& estimates) {
  return std::count_if(estimates.begin(), estimates.end(), [](const ChannelEstimate& estimate) {
    return estimate.gain_ratio.high - estimate.gain_ratio.low > 2.0 * 1.96 * kVisible;
  });
}

/// Searches with a free noise model. Such a model can swallow structure: where what is left is far
/// smoother than noise, or where nothing is found and the gains are not known either, a bounded one
/// is tried too, and the one whose repair carries over from the first three quarters of the data to
/// the last decides.
Explained explain(const ModelSpec& model, int model_inputs, const Recording& recording,
                  const DiagnosisSettings& asked, const SearchSettings& settings) {
  const NoiseModel free{kNoiseOrder, 0.0}, bounded{1, kBound};
  Explained explained = explain_with(free, model, model_inputs, recording, settings);
  const bool blind =
      explained.found.named.empty() &&
      unknown_gains(estimate_channels(*explained.problem, explained.found, asked)) > 0;
  if (!blind && !is_smooth(explained)) return explained;
  const Index first = 3 * recording.samples() / 4;
  const Recording train = part(recording, 0, first);
  const double with_free =
      log_error(explain_with(free, model, model_inputs, train, settings), recording, first);
  const double with_bounded =
      log_error(explain_with(bounded, model, model_inputs, train, settings), recording, first);
  if (!(with_bounded < with_free - (blind ? kSome : kClear))) return explained;
  return explain_with(bounded, model, model_inputs, recording, settings);
}

/// What was seen and has no name: how likely by chance, and how much of the residual it makes up.
Unexplained to_unexplained(const SearchResult& found, std::size_t index, Problem& problem) {
  const Effect& effect = found.named[index].effect;
  Unexplained left;
  left.cv = effect.subject.cv;
  left.input = effect.subject.input;
  left.manner = effect.subject.kind;
  const auto of_cv = [&](const CvFit& fit) { return fit.cv == left.cv; };
  const auto fit = std::find_if(found.fit.cvs.begin(), found.fit.cvs.end(), of_cv);
  std::vector<Effect> others = found.fit.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(index));
  const VectorXd change =
      problem.simulate(found.fit.effects, left.cv) - problem.simulate(others, left.cv);
  const CvData& data = problem.data(left.cv);
  const double rows = std::max(1.0, data.known.sum());
  const double mean = change.dot(data.known) / rows;
  const double made = ((change.array() - mean).square() * data.known.array()).sum();
  left.share = made / (made + fit->residual.squaredNorm());
  // Odds on the scale of a log likelihood ratio, with all that it was picked from paid for.
  const auto numbers = static_cast<double>(effect.coordinates.size());
  left.p_value = f_upper_tail(std::max(0.0, found.named[index].evidence) / numbers, numbers, rows);
  return left;
}

/// All of diagnose() but for giving up. `settings.progress` is there and throws.
Diagnosis run(const ModelSpec& given, const Recording& recording, const Recording* validation,
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
  SearchSettings search_settings;
  search_settings.max_findings = settings.max_findings;
  search_settings.progress = settings.progress;
  const Explained explained = explain(model, base.input_count, fitted, settings, search_settings);
  Problem& problem = *explained.problem;
  const SearchResult& found = explained.found;

  for (std::size_t i = 0; i < found.named.size(); ++i)
    if (found.named[i].effect.subject.cause == Cause::kUnnamed)
      diagnosis.unexplained.push_back(to_unexplained(found, i, problem));
    else
      diagnosis.findings.push_back(to_finding(found, i, problem));
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
  diagnosis.channels = estimate_channels(problem, found, settings);

  measure_gain(problem, found, model, base, recording, validation, settings, diagnosis);

  if (!diagnosis.findings.empty() || !diagnosis.unexplained.empty()) {
    diagnosis.verdict = DiagnosisVerdict::kMismatch;
    return diagnosis;
  }
  const bool strong =
      std::any_of(diagnosis.refused.begin(), diagnosis.refused.end(),
                  [](const Finding& finding) { return finding.evidence > kStrong; });
  if (strong) {
    diagnosis.verdict = DiagnosisVerdict::kUndetermined;
    diagnosis.reason = "what explains the samples that were fitted does not hold on the others";
    return diagnosis;
  }
  diagnosis.verdict = DiagnosisVerdict::kMatch;
  const std::ptrdiff_t unseen = unknown_gains(diagnosis.channels);
  if (unseen > 0) {
    diagnosis.verdict = DiagnosisVerdict::kUndetermined;
    diagnosis.reason = "the inputs move too little beside the noise: the gains of " +
                       std::to_string(unseen) + " of " + std::to_string(diagnosis.channels.size()) +
                       " channels are not known to within 25 %";
  }
  return diagnosis;
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
                   const DiagnosisSettings& asked) {
  DiagnosisSettings settings = asked;
  settings.progress = or_give_up(asked.progress);
  try {
    return run(given, recording, validation, settings);
  } catch (const GivenUp&) {
    Diagnosis diagnosis;
    diagnosis.reason = "stopped";
    diagnosis.extended = given;
    return diagnosis;
  }
}

}  // namespace mpm
