#include "core/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/diagnosis/account.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/clock.hpp"
#include "core/identify/diagnosis/compressed.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/late.hpp"
#include "core/identify/diagnosis/nameable.hpp"
#include "core/identify/diagnosis/passed.hpp"
#include "core/identify/diagnosis/rejected.hpp"
#include "core/identify/diagnosis/seldom_read.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"
#include "core/identify/diagnosis/state_space_form.hpp"
#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/diagnosis/verdict.hpp"
#include "core/identify/evidence/change_row.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "core/identify/evidence/measured_sticking.hpp"
#include "core/identify/evidence/outside_movement.hpp"
#include "core/identify/evidence/unanswered_pulses.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/split.hpp"
#include "core/statistics/readback.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kCompressed =
    "a historian has compressed a CV, and what it took away can look like errors of the model";

/// Thrown where the caller's `progress` says so; ends all loops at once.
struct GivenUp {};

/// Where pieces of the search are nested, the first throw ends the outer ones only once what this
/// thread has begun within them has come here as well: after `given_up` nobody is asked again. Both
/// must outlive what is returned.
std::function<bool(double)> or_give_up(const std::function<bool(double)>& progress,
                                       bool& given_up) {
  return [&progress, &given_up](double share) {
    given_up = given_up || (progress && !progress(share));
    if (given_up) throw GivenUp();
    return true;
  };
}

enum class Worth { kFinding, kSmall, kUnproved };

/// Whether the calibrated test says that what an effect does to its channels may matter.
using MayMatter = std::function<bool(const Effect&)>;

/// An error of a channel, or a scale that has changed, that the calibrated test finds too small to
/// matter is small where its own numbers are; else one of the two is wrong: the test, where
/// predictions gain overwhelmingly.
Worth worth_of(std::size_t i, const Account& kept, const Judges& judges,
               const MayMatter& may_matter) {
  const Effect& effect = kept.found.named[i].effect;
  const Problem& problem = *kept.problem;
  const bool judged = is_error_of_channel(effect) || (is_scale(effect) && effect.onset > 0);
  if (!judged || may_matter(effect)) return Worth::kFinding;
  if (material_errors(effect, kSmall) == 0) return Worth::kSmall;
  const bool overwhelms = kept.selection.fates[i] == Fate::kRepaired &&
                          kept.selection.sure_gains[i] >= kOverwhelmingGain &&
                          moved_from_outside(effect, problem.model(), judges.outside_shares);
  return overwhelms ? Worth::kFinding : Worth::kUnproved;
}

/// The jump that was not named, beside all that was.
Finding to_doubted(Problem& problem, const SearchResult& found) {
  SearchResult alone;
  alone.named = {*found.doubted};
  std::vector<Effect> effects = found.fit.effects;
  effects.push_back(found.doubted->effect);
  alone.fit =
      problem.fit(effects, effects.size() - 1, touched(effects.back(), problem), kEstimateSteps);
  alone.named.front().effect = alone.fit.effects.back();
  Finding finding = to_finding(alone, 0, problem);
  finding.repaired = false;
  finding.refused = "only its first sample speaks for it, and noise makes shocks, too";
  return finding;
}

/// What was named, as findings, and what has no name; most important first, what no repair removes
/// last.
void state(const Account& kept, const Recording& fitted, const Judges& judges,
           const ChannelTests& tests, const MayMatter& may_matter, Diagnosis& diagnosis) {
  Problem& problem = *kept.problem;
  const SearchResult& found = kept.found;
  const Selection& selection = kept.selection;
  std::vector<Finding> unproved;
  std::vector<bool> unclear(static_cast<std::size_t>(problem.model().cv_count), false);
  const auto mark_unclear = [&](const Effect& effect) {
    for (const int cv : touched(effect, problem)) unclear[static_cast<std::size_t>(cv)] = true;
  };
  const auto moves_of = [&](const Effect& effect) {
    return moves(fitted.aux.col(effect.place.aux));
  };
  const auto alone = [&](std::size_t i) {
    const int cv = found.named[i].effect.place.cv;
    return std::count_if(found.named.begin(), found.named.end(), [&](const Named& named) {
             return touches(named.effect, problem.model(), cv);
           }) == 1;
  };
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    const Cause& cause = cause_of(effect);
    Finding finding = to_finding(found, i, problem);
    add_own_setpoint(effect, tests, judges.aux, finding);
    finding.repaired = selection.fates[i] == Fate::kRepaired;
    const bool of_setpoint = effect.place.aux >= judges.aux;
    const char* not_setpoint = of_setpoint ? why_not_setpoint(found.named[i], alone(i),
                                                              moves_of(effect), tests, judges.aux)
                                           : nullptr;
    finding.refused = not_setpoint != nullptr ? not_setpoint
                      : of_setpoint           ? "a set-point is no input of a model"
                                              : why_not_in_model(selection.fates[i]);
    finding.explains = selection.explains[i];
    if (const auto other = selection.with[i]) finding.with = subject_of(found.named[*other].effect);
    const Worth worth = worth_of(i, kept, judges, may_matter);
    if (worth == Worth::kSmall) {
      diagnosis.small.push_back(std::move(finding));
    } else if (worth == Worth::kUnproved) {
      finding.refused = "for the test of the channels it is too small to matter";
      unproved.push_back(std::move(finding));
      mark_unclear(effect);
    } else if (causes::is_unnamed(cause)) {
      if (effect.place.cv < 0 || !judges.compressed.cv(effect.place.cv))
        diagnosis.unexplained.push_back(to_unexplained(found, i, problem));
      mark_unclear(effect);
    } else if (not_setpoint != nullptr || (of_setpoint && finding.explains < kSetpointExplains)) {
      unproved.push_back(std::move(finding));
      mark_unclear(effect);
    } else {
      diagnosis.findings.push_back(std::move(finding));
    }
  }
  diagnosis.refused = kept.refused;
  diagnosis.refused.insert(diagnosis.refused.end(), unproved.begin(), unproved.end());
  for (const Effect& effect : kept.refused_effects) mark_unclear(effect);
  std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.evidence > b.evidence; });
  if (found.suspect) {
    diagnosis.suspect = Finding{};
    diagnosis.suspect->subject = subject_of(found.suspect->effect);
    diagnosis.suspect->evidence = found.suspect->evidence;
    mark_unclear(found.suspect->effect);
  }
  if (found.doubted) {
    diagnosis.refused.push_back(to_doubted(problem, found));
    mark_unclear(found.doubted->effect);
  }
  // Where structure is missing what is left is no noise.
  for (const Cause* cause : causes::all())
    for (Finding& finding : cause->left_in(problem, found.fit)) {
      finding.repaired = false;
      if (!finding.refused.empty()) {
        diagnosis.refused.push_back(std::move(finding));
      } else if (unclear[static_cast<std::size_t>(finding.subject.place.cv)]) {
        finding.refused = "what is left of the CV is no noise: structure is missing";
        diagnosis.refused.push_back(std::move(finding));
      } else {
        finding.refused = "no repair of a model removes it";
        diagnosis.findings.push_back(std::move(finding));
      }
    }
}

/// Of each CV, whether the small corrections that came with what was repaired carry over too.
std::vector<bool> carries_over(const Problem& problem, const SearchResult& found,
                               const std::vector<bool>& in, const Judges& judges) {
  const ModelSpec& model = problem.model();
  Unseen& unseen = judges.unseen;
  std::vector<bool> keep(static_cast<std::size_t>(model.cv_count), true);
  if (std::find(in.begin(), in.end(), true) == in.end()) return keep;
  const ModelSpec with_all = extend(problem, found, in, keep, judges.open);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const CvScore gain = score(unseen.measured(cv), unseen.simulated(model, cv),
                               unseen.simulated(with_all, cv), unseen.block(), unseen.seed());
    if (gain.rmse_after > gain.rmse_before) keep[static_cast<std::size_t>(cv)] = false;
  }
  return keep;
}

/// What was given as a state space is one again where it can be.
ModelSpec in_form_of(const ModelSpec& given, const ModelSpec& base, ModelSpec extended) {
  if (!given.state_space) return extended;
  std::optional<ModelSpec> system = in_state_space(given, base, extended);
  return system ? std::move(*system) : extended;
}

/// Whether something was named in a CV, and nothing of that is in the extended model.
bool all_refused(const Account& kept, const ModelSpec& model, int cv) {
  const SearchResult& found = kept.found;
  const Selection& selection = kept.selection;
  bool tried = std::any_of(kept.refused_effects.begin(), kept.refused_effects.end(),
                           [&](const Effect& effect) { return touches(effect, model, cv); });
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    if (causes::is_unnamed(cause_of(effect)) || !touches(effect, model, cv)) continue;
    if (selection.fates[i] == Fate::kRepaired) return false;
    tried = true;
  }
  return tried;
}

/// How the inputs moved, and whether the channels of each are known.
std::vector<InputMovement> movements(const std::vector<std::optional<double>>& outside,
                                     const std::vector<ChannelEstimate>& channels) {
  std::vector<InputMovement> result;
  for (std::size_t i = 0; i < outside.size(); ++i) {
    InputMovement& movement = result.emplace_back();
    movement.input = static_cast<int>(i);
    movement.outside_share = outside[i];
    std::vector<ChannelEstimate> own;
    for (const ChannelEstimate& channel : channels)
      if (channel.input == movement.input) own.push_back(channel);
    movement.excited = outside[i] && unknown_gains(own) < static_cast<std::ptrdiff_t>(own.size());
  }
  return result;
}

void add_horizons(const Unseen& unseen, const VectorXd& before, const VectorXd& after,
                  CvScore& score) {
  for (const Index horizon : unseen.horizons())
    score.horizons.push_back({horizon, rms_of_squares(unseen.prediction_errors(before, horizon)),
                              rms_of_squares(unseen.prediction_errors(after, horizon))});
}

/// With aux signals that read an input back, or the valve behind it, as if they stood still: beside
/// it they are no causes, and hide what its channels do.
Recording without_readbacks(Recording recording) {
  recording.sticking = measured_sticking(recording);
  for (const MeasuredSticking& position : recording.sticking)
    recording.aux.col(position.aux).setZero();
  for (Index a = 0; a < recording.aux.cols(); ++a)
    if (reads_back(recording.inputs, recording.aux.col(a))) recording.aux.col(a).setZero();
  return recording;
}

/// With the pulses of inputs unknown that the plant did not see; they are added to `pulses`.
Recording without_unanswered(const ModelSpec& model, const Recording& recording,
                             std::vector<Pulse>& pulses) {
  const std::vector<Pulse> all = short_pulses(recording);
  const std::vector<Pulse> none = unanswered(model, without(recording, all), all);
  pulses.insert(pulses.end(), none.begin(), none.end());
  return without(recording, none);
}

/// Whether the model, driven by these inputs alone, ends at no number: where a term of a CV's own
/// pushes it away it may have no rest, and only its controller holds it.
bool runs_away(const ModelSpec& model, const Recording& recording) {
  Simulator simulator(recording);
  for (int cv = 0; cv < model.cv_count; ++cv)
    if (!simulator.cv(model, cv).allFinite()) return true;
  return false;
}

/// All of diagnose() of CVs that are read in one cycle, but for giving up. `settings.progress` is
/// there and throws.
Diagnosis judge(const ModelSpec& given, const AtReadings& at_readings,
                const DiagnosisSettings& settings) {
  const Recording& whole = at_readings.recording;
  const Recording* unseen_runs = at_readings.validation;
  Diagnosis diagnosis;
  const ModelSpec base = in_channels(at_readings.model);
  const Recording measured =
      without_unanswered(base, without_readbacks(whole), diagnosis.unanswered);
  Recording recording = with_setpoints(measured);
  std::optional<Recording> validation;
  if (unseen_runs != nullptr)
    validation =
        with_setpoints(without_unanswered(base, *unseen_runs, diagnosis.validation_unanswered));
  const auto aux = static_cast<int>(measured.aux.cols());
  const Index samples = recording.samples();
  diagnosis.samples = samples;
  diagnosis.extended = given;

  const Compressed compressed(measured);
  const ModelSpec model = with_aux_inputs(base, recording);
  const MatrixXd residuals = free_run_residuals(model, recording);
  diagnosis.reason =
      runs_away(model, recording) ||
              (validation && runs_away(with_aux_inputs(base, *validation), *validation))
          ? "the model runs away: left alone with these inputs its simulation grows without bound"
          : why_not_judged(residuals);
  if (!diagnosis.reason.empty()) return diagnosis;
  const ModelSpec tested = with_aux_inputs(base, measured);
  const ChannelTests tests(tested, measured, residuals);
  const ChannelTests by_monitor(tested, measured, residuals, OwnPast::kAsMonitor);
  recording.changed = change_row(tested, measured, residuals, tests);
  for (int cv = 0; cv < model.cv_count; ++cv)
    recording.noise_before.push_back(tests.noise_before(cv));
  diagnosis.fit_samples = validation ? samples : fitted_rows(recording, settings.fit_share);
  diagnosis.validation_samples =
      validation ? validation->samples() : samples - diagnosis.fit_samples;
  const Recording fitted = part(recording, 0, diagnosis.fit_samples);
  const std::vector<std::optional<double>> outside = outside_shares(recording, residuals);

  SearchSettings search_settings;
  search_settings.max_findings = settings.max_findings;
  search_settings.threads = settings.threads;
  search_settings.progress = settings.progress;
  search_settings.curves = at_readings.every == 1.0;
  search_settings.may_name =
      nameable(model, {settings.mv_count, base.input_count, aux}, tests, by_monitor, outside);
  Unseen unseen(validation ? *validation : recording, diagnosis.validation_samples, model,
                settings.seed);
  const Judges judges{unseen, aux,
                      [&](int cv, int input, bool wrong) {
                        // Where only a disturbance was found they soak up what it leaves.
                        const auto i = static_cast<std::size_t>(input);
                        return wrong &&
                               (tests.reject({{cv, input}}) ||
                                (i < outside.size() && outside[i].value_or(0.0) >= kMostlyOutside));
                      },
                      outside, compressed};
  const Witness witness{tests, by_monitor, [&](const std::vector<Stage>& repaired, OwnPast past) {
                          return ChannelTests(tested, measured,
                                              free_run_residuals(repaired, recording), past);
                        }};
  const Account kept =
      account_for(model, base.input_count, fitted, judges, witness, search_settings);
  Problem& problem = *kept.problem;
  diagnosis.channels = estimate_channels(problem, kept.found, search_settings);
  diagnosis.inputs = movements(outside, diagnosis.channels);
  const std::vector<bool> in = repaired(kept.selection);
  const std::vector<bool> keep = carries_over(problem, kept.found, in, judges);
  const ModelSpec extended = extend(problem, kept.found, in, keep, judges.open);
  diagnosis.before = unseen.free_runs(model);
  diagnosis.after = unseen.free_runs(extended);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const Index rows = unseen.rows();
    diagnosis.scores.push_back(score(unseen.measured(cv), diagnosis.before.col(cv).tail(rows),
                                     diagnosis.after.col(cv).tail(rows), unseen.block(),
                                     unseen.seed() + static_cast<std::uint64_t>(cv)));
    diagnosis.scores.back().refused = all_refused(kept, model, cv);
    add_horizons(unseen, unseen.measured(cv) - diagnosis.before.col(cv).tail(rows),
                 unseen.measured(cv) - diagnosis.after.col(cv).tail(rows), diagnosis.scores.back());
  }
  if (std::find(in.begin(), in.end(), true) != in.end()) {
    const ModelSpec own = in_channels(given);
    const ModelSpec repaired_own =
        extend(with_aux_inputs(own, recording), problem, kept.found, in, keep, judges.open);
    diagnosis.extended = in_form_of(given, own, finish(repaired_own, own, diagnosis.new_inputs));
  }
  if (validation) {
    diagnosis.validation_before = std::move(diagnosis.before);
    diagnosis.validation_after = std::move(diagnosis.after);
    Simulator first(recording);
    diagnosis.before = free_runs(first, model);
    diagnosis.after = free_runs(first, extended);
  }
  // What the step response bears does not matter whatever its numbers are, unless it is much of it;
  // a dead time alone is judged by its size. And what began later is less in the mean of all rows
  // than since then.
  const MayMatter may_matter = [&](const Effect& effect) {
    const auto channels = channels_of(effect, model, base.input_count);
    const bool in_all = tests.may_matter(channels);
    if (effect.onset == 0)
      return in_all && (material_errors(effect, kSmall) == 0 || !tests.bears(channels) ||
                        share_of_step(effect, problem.surroundings(), model) > kMuchOfStep);
    if (in_all) return true;
    const Index rest = samples - effect.onset;
    return ChannelTests(tested, part(measured, effect.onset, rest), residuals.bottomRows(rest))
        .may_matter(channels);
  };
  state(kept, fitted, judges, tests, may_matter, diagnosis);
  for (Finding& finding : find_passed(extended, base.input_count, fitted,
                                      without_a_name(kept, model), unseen, search_settings))
    diagnosis.findings.push_back(std::move(finding));
  if (!validation) {
    Late late = begun_late(extended, tested, recording, measured, diagnosis.fit_samples,
                           {settings.mv_count, base.input_count, aux}, outside, search_settings);
    for (Finding& finding : late.findings) {
      const char* why = compressed.may_have_made(finding)                      ? kMadeByCompression
                        : may_be_refused(finding, kept.refused_effects, model) ? kMayBeRefused
                                                                               : nullptr;
      if (why != nullptr) finding.refused = why;
      (why != nullptr ? diagnosis.refused : diagnosis.findings).push_back(std::move(finding));
    }
    diagnosis.refused.insert(diagnosis.refused.end(), late.doubted.begin(), late.doubted.end());
  }
  diagnosis.rejected = rejected_channels(base, tests, diagnosis);
  const std::vector<Place> by_monitor_too = rejected_channels(base, by_monitor, diagnosis);
  std::erase_if(diagnosis.rejected, [&](const Place& at) {
    return std::find(by_monitor_too.begin(), by_monitor_too.end(), at) == by_monitor_too.end();
  });
  // What has begun half-way drowns in the test of all rows, and a monitor remembers no more either.
  if (diagnosis.findings.empty() && diagnosis.rejected.empty()) {
    const Index half = samples / 2;
    const ChannelTests of_half(tested, part(measured, samples - half, half),
                               residuals.bottomRows(half), OwnPast::kAsMonitor);
    diagnosis.rejected = rejected_channels(base, of_half, diagnosis);
  }
  // Beside a change half-way the nonlinear test sees bends that are not there.
  if (diagnosis.findings.empty()) diagnosis.bent = bent_channels(base, by_monitor, diagnosis);
  const std::size_t doubted =
      std::erase_if(diagnosis.rejected, [&](const Place& at) { return compressed.cv(at.cv); });
  if (!diagnosis.rejected.empty() && std::find(in.begin(), in.end(), true) != in.end())
    keep_rejected(ChannelTests(tested, measured, free_run_residuals(extended, recording)),
                  diagnosis.rejected);
  decide({least_explained(residuals, recording.cvs),
          !sticking_loops(base, settings.mv_count, whole).empty(),
          loses_a_cv(residuals, recording.cvs, diagnosis.fit_samples)},
         diagnosis);
  if (compressed.any() && diagnosis.verdict != DiagnosisVerdict::kMismatch &&
      (doubted > 0 || diagnosis.verdict == DiagnosisVerdict::kUndetermined)) {
    diagnosis.verdict = DiagnosisVerdict::kUndetermined;
    diagnosis.reason = kCompressed;
  }
  tell_on_clock(recording, given, diagnosis);
  return diagnosis;
}

}  // namespace

Index needed_samples(const ModelSpec& model) {
  // In the part that is fitted, two thirds.
  Index most = 0;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const auto channels = std::count_if(model.channels.begin(), model.channels.end(),
                                        [cv](const ChannelSpec& c) { return c.cv == cv; });
    most = std::max<Index>(most, model.state_space ? 3 * model.input_count : 3 * channels);
  }
  return 3 * kRowsPerNumber * (most + kLeastOrder + kOtherNumbers) / 2;
}

Index rows_to_diagnose(Index samples) { return samples > kMostDiagnosed ? kCondensed : samples; }

Diagnosis diagnose(const ModelSpec& given, const Recording& recording, const Recording* validation,
                   const DiagnosisSettings& asked) {
  DiagnosisSettings settings = asked;
  bool given_up = false;
  settings.progress = or_give_up(asked.progress, given_up);
  try {
    const ModelSpec base = in_channels(given);
    const std::vector<Readings> all = readings_of(recording);
    if (static_cast<int>(all.front().cvs.size()) == given.cv_count || runs_away(base, recording) ||
        (validation != nullptr && runs_away(base, *validation)))
      return judge(given, {given, 1.0, recording, validation}, settings);
    Diagnosis diagnosis = by_readings(base, {recording, validation}, all, settings, judge);
    diagnosis.extended = in_form_of(given, base, std::move(diagnosis.extended));
    return diagnosis;
  } catch (const GivenUp&) {
    Diagnosis diagnosis;
    diagnosis.reason = "stopped";
    diagnosis.extended = given;
    return diagnosis;
  }
}

}  // namespace mpm
