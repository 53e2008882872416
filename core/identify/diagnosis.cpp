#include "core/identify/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/identify/channel_edit.hpp"
#include "core/identify/extension.hpp"
#include "core/identify/initial_state.hpp"
#include "core/identify/noise_change.hpp"
#include "core/identify/problem.hpp"
#include "core/identify/search.hpp"
#include "core/identify/validation.hpp"
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
/// Share of the work that is done when all causes have been looked for.
constexpr double kSearched = 0.9;

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

double mean_of_finite(const VectorXd& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value, ++count;
  return sum > 0.0 ? sum / count : 1.0;
}

double slowest_samples(const ModelSpec& model) {
  double slowest = 1.0;
  for (const ChannelSpec& channel : model.channels)
    slowest = std::max(slowest, slowest_time_constant_s(channel, model.sample_time_s));
  return slowest / model.sample_time_s;
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

/// A CV's free run that begins where the measurements do.
VectorXd free_run(Simulator& simulator, const ModelSpec& model, int cv) {
  return start_on_data(simulator.cv(model, cv), simulator.recording().cvs.col(cv),
                       decay_times(model, cv));
}

MatrixXd free_runs(Simulator& simulator, const ModelSpec& model) {
  MatrixXd result(simulator.recording().samples(), model.cv_count);
  for (int cv = 0; cv < model.cv_count; ++cv) result.col(cv) = free_run(simulator, model, cv);
  return result;
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

/// Searches with a free noise model. Where what is left is far smoother than noise, structure is
/// left that such a noise model swallows; then a bounded one is tried too, and the one whose repair
/// carries over from the first three quarters of the data to the last decides.
Explained explain(const ModelSpec& model, int model_inputs, const Recording& recording,
                  const SearchSettings& settings) {
  const NoiseModel free{kNoiseOrder, 0.0}, bounded{1, kBound};
  Explained explained = explain_with(free, model, model_inputs, recording, settings);
  bool smooth = false;
  for (const CvFit& fit : explained.found.fit.cvs) {
    const CvData& data = explained.problem->data(fit.cv);
    const double all = fit.residual.squaredNorm() / std::max(1.0, data.known.sum());
    if (fit.variance < kSmooth * all) smooth = true;
  }
  if (!smooth) return explained;
  const Index first = 3 * recording.samples() / 4;
  const Recording train = part(recording, 0, first);
  const double with_free =
      log_error(explain_with(free, model, model_inputs, train, settings), recording, first);
  const double with_bounded =
      log_error(explain_with(bounded, model, model_inputs, train, settings), recording, first);
  if (!(with_bounded < with_free - kClear)) return explained;
  return explain_with(bounded, model, model_inputs, recording, settings);
}

/// What was seen and has no name: how likely by chance, and how much of the residual it makes up.
Unexplained to_unexplained(const SearchResult& found, std::size_t index, Problem& problem) {
  const Effect& effect = found.named[index].effect;
  Unexplained left;
  left.cv = effect.subject.cv;
  left.input = effect.subject.input;
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

/// Which effects carry over to samples that no fit has seen, and what they gain there.
///
/// One effect after the other, weakest first, is left out of the extension: on the CVs that it
/// touches the free run must be the better for having it. If it is the worse for it, the finding
/// was none; if the difference is within its bootstrap interval, the finding stands but repairs
/// nothing.
void measure_gain(const Problem& problem, SearchResult found, const ModelSpec& model,
                  const ModelSpec& base, const Recording& recording, const Recording* validation,
                  const DiagnosisSettings& settings, Diagnosis& diagnosis) {
  const Recording& unseen = validation ? *validation : recording;
  const Index rows = diagnosis.validation_samples;
  Simulator simulator(unseen);
  const auto block = static_cast<Index>(2.0 * slowest_samples(model)) + 10;
  std::vector<bool> keep(static_cast<std::size_t>(model.cv_count), true);
  const auto measured = [&](int cv) { return unseen.cvs.col(cv).tail(rows); };
  const auto simulated = [&](const ModelSpec& spec, int cv) -> VectorXd {
    return free_run(simulator, spec, cv).tail(rows);
  };

  std::vector<std::size_t> order(found.named.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return found.named[a].evidence < found.named[b].evidence;
  });
  std::vector<bool> in(found.named.size(), true);
  for (std::size_t i = 0; i < in.size(); ++i)
    in[i] = found.named[i].effect.subject.cause != Cause::kUnnamed;
  for (const std::size_t i : order) {
    settings.progress(kSearched);
    if (found.named[i].effect.certain || !in[i]) continue;
    const ModelSpec with = extend(problem, found, in, keep);
    in[i] = false;
    const ModelSpec without = extend(problem, found, in, keep);
    VectorXd old_errors = VectorXd::Zero(rows), new_errors = VectorXd::Zero(rows);
    for (int cv = 0; cv < model.cv_count; ++cv) {
      if (!touches(found.named[i].effect, model, cv)) continue;
      const VectorXd new_error = (measured(cv) - simulated(with, cv)).cwiseAbs2();
      const VectorXd old_error = (measured(cv) - simulated(without, cv)).cwiseAbs2();
      const double scale = mean_of_finite(new_error);
      old_errors += old_error / scale;
      new_errors += new_error / scale;
    }
    const CvScore gain = score_errors(old_errors, new_errors, block, settings.seed + i);
    in[i] = gain.gain_low > 0.0;
    if (in[i]) continue;
    const auto same = std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                                   [&](const Finding& finding) {
                                     return finding.subject == found.named[i].effect.subject &&
                                            finding.evidence == found.named[i].evidence;
                                   });
    if (same == diagnosis.findings.end()) continue;
    same->repaired = false;
    if (gain.rmse_after < gain.rmse_before) continue;
    diagnosis.refused.push_back(*same);
    diagnosis.findings.erase(same);
  }

  const bool any = std::find(in.begin(), in.end(), true) != in.end();
  const MatrixXd before = free_runs(simulator, model);
  ModelSpec extended = any ? extend(problem, found, in, keep) : model;
  // The small corrections that came with the findings have to carry over too.
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const CvScore gain = score(measured(cv), before.col(cv).tail(rows), simulated(extended, cv),
                               block, settings.seed);
    if (gain.rmse_after > gain.rmse_before) keep[static_cast<std::size_t>(cv)] = false;
  }
  if (any) extended = extend(problem, found, in, keep);
  const MatrixXd after = free_runs(simulator, extended);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    CvScore result = score(measured(cv), before.col(cv).tail(rows), after.col(cv).tail(rows), block,
                           settings.seed + static_cast<std::uint64_t>(cv));
    for (std::size_t i = 0; i < in.size(); ++i)
      if (!in[i] && found.named[i].effect.subject.cause != Cause::kUnnamed &&
          touches(found.named[i].effect, model, cv))
        result.refused = true;
    diagnosis.scores.push_back(result);
  }
  if (any) diagnosis.extended = finish(extended, base, diagnosis.new_inputs);
  if (validation) {
    diagnosis.validation_before = before;
    diagnosis.validation_after = after;
    Simulator first(recording);
    diagnosis.before = free_runs(first, model);
    diagnosis.after = free_runs(first, extended);
  } else {
    diagnosis.before = before;
    diagnosis.after = after;
  }
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
  const Explained explained = explain(model, base.input_count, fitted, search_settings);
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
    if (diagnosis.findings.empty())
      diagnosis.reason = "what is wrong is none of the causes that have a name here";
    return diagnosis;
  }
  diagnosis.verdict = DiagnosisVerdict::kMatch;
  const auto unseen = std::count_if(
      diagnosis.channels.begin(), diagnosis.channels.end(), [](const ChannelEstimate& estimate) {
        return estimate.gain_ratio.high - estimate.gain_ratio.low > 2.0 * 1.96 * kVisible;
      });
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
