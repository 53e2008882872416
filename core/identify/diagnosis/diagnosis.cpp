#include "core/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/clock.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/late.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/evidence/outside_movement.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/plateau.hpp"
#include "core/identify/fit/split.hpp"
#include "core/identify/valves/valve_shape.hpp"
#include "core/text/number_text.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Thrown where the caller's `progress` says so; ends all loops at once.
struct GivenUp {};

std::function<bool(double)> or_give_up(const std::function<bool(double)>& progress) {
  return [&progress](double share) {
    if (progress && !progress(share)) throw GivenUp();
    return true;
  };
}

/// The channels that an effect changes, as (CV, input).
std::vector<std::pair<int, int>> channels_of(const Effect& effect, const ModelSpec& model,
                                             int model_inputs) {
  const Place& place = effect.place;
  const int input = place.aux >= 0 ? model_inputs + place.aux : place.input;
  if (place.cv >= 0 && input >= 0) return {{place.cv, input}};
  std::vector<std::pair<int, int>> channels;
  for (const ChannelSpec& channel : model.channels)
    if ((place.cv < 0 || channel.cv == place.cv) && (input < 0 || channel.input == input))
      channels.emplace_back(channel.cv, channel.input);
  return channels;
}

/// Measured minus free run, on all rows; NaN where a CV is unknown or clips.
MatrixXd residuals_of(const ModelSpec& model, const Recording& recording) {
  Simulator simulator(recording);
  MatrixXd residuals = recording.cvs - free_runs(simulator, model);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const auto measured = recording.cvs.col(cv);
    const Plateaus plateaus = find_plateaus(measured);
    for (Index k = 0; k < measured.size(); ++k)
      if ((plateaus.low && measured(k) <= *plateaus.low) ||
          (plateaus.high && measured(k) >= *plateaus.high))
        residuals(k, cv) = std::numeric_limits<double>::quiet_NaN();
  }
  return residuals;
}

/// Why the extended model does without a finding.
const char* why_not_in_model(Fate fate) {
  switch (fate) {
    case Fate::kNoBetter:
      return "with it predictions on unseen samples are not better beyond doubt";
    case Fate::kRefused:
      return "with it predictions on unseen samples are worse";
    case Fate::kRepaired:
      break;
  }
  return "";
}

/// What accuses a part of the plant of more than a wrong number is named only if it makes the model
/// better beyond doubt.
bool must_be_proved(const Effect& effect, int aux) {
  return cause_of(effect).is_input_block() || cause_of(effect).settles_channel(effect) ||
         effect.place.aux >= aux;
}

/// What stays of what was found, once nothing stands on what unseen data refuse.
struct Kept {
  SearchResult found;
  Selection selection;  ///< refuses nothing of it
  std::vector<Effect> refused_effects;
  std::vector<Finding> refused;  ///< the same, most important last
};

bool is_refused(const SearchResult& found, const Selection& selection, std::size_t i) {
  return selection.fates[i] == Fate::kRefused && !found.named[i].effect.certain;
}

/// Takes out what is refused and fits the rest anew, until nothing is refused any more: what only
/// made sense beside it goes too.
Kept keep(Problem& problem, const SearchResult& found, const Judges& judges,
          const SearchSettings& settings) {
  const auto judge = [&](const SearchResult& of) {
    return select(problem, of, judges, [&] { settings.progress(kSearched); });
  };
  Kept kept{found, judge(found), {}, {}};
  for (;;) {
    const SearchResult& before = kept.found;
    std::vector<bool> out;
    for (std::size_t i = 0; i < before.named.size(); ++i)
      out.push_back(is_refused(before, kept.selection, i));
    if (std::find(out.begin(), out.end(), true) == out.end()) return kept;
    SearchResult rest = without(problem, before, out, settings);
    const auto stays = [&](const Effect& effect) {
      return std::any_of(rest.named.begin(), rest.named.end(), [&](const Named& named) {
        return subject_of(named.effect) == subject_of(effect) && named.effect.onset == effect.onset;
      });
    };
    for (const std::size_t i : kept.selection.order) {
      const Effect& effect = before.named[i].effect;
      if (causes::is_unnamed(cause_of(effect)) || (!out[i] && stays(effect))) continue;
      if (!out[i] && causes::is_constant_offset(effect)) continue;
      Finding finding = to_finding(before, i, problem);
      finding.repaired = false;
      finding.refused = out[i] ? why_not_in_model(Fate::kRefused)
                               : "without what was refused it explains nothing";
      finding.explains = kept.selection.explains[i];
      kept.refused.push_back(std::move(finding));
      kept.refused_effects.push_back(effect);
    }
    kept.selection = judge(rest);
    kept.found = std::move(rest);
  }
}

/// What the search finds, and what unseen data leave of it.
struct Account {
  std::unique_ptr<Problem> problem;
  Kept kept;
};

/// Whether all that was named without the test of the channels takes so much off the errors of
/// predictions on unseen samples that it is believed: where inputs move mostly from outside the
/// loop no feedback can make that up.
bool overwhelms(const Kept& kept, const SearchSettings& tested) {
  bool any = false;
  for (std::size_t i = 0; i < kept.found.named.size(); ++i) {
    const Effect& effect = kept.found.named[i].effect;
    if (effect.certain || tested.may_name(effect)) continue;
    any = true;
    if (kept.selection.fates[i] != Fate::kRepaired ||
        kept.selection.sure_gains[i] < kOverwhelmingGain)
      return false;
  }
  return any;
}

Account account_for(const ModelSpec& model, int model_inputs, const Recording& fitted,
                    const Judges& judges, const SearchSettings& settings) {
  const auto take = [&](const SearchSettings& with) {
    Explained explained = explain(model, model_inputs, fitted, with);
    Kept kept = keep(*explained.problem, explained.found, judges, with);
    return Account{std::move(explained.problem), std::move(kept)};
  };
  Account account = take(settings);
  const std::optional<Named>& suspect = account.kept.found.suspect;
  if (!suspect || suspect->evidence < kStrongEvidence ||
      !moved_from_outside(suspect->effect, model, judges.outside_shares))
    return account;
  SearchSettings open = settings;
  open.may_name = [&](const Effect& effect) {
    return settings.may_name(effect) || (cause_of(effect).acts_through_channels() &&
                                         moved_from_outside(effect, model, judges.outside_shares));
  };
  Account other = take(open);
  return overwhelms(other.kept, settings) ? std::move(other) : std::move(account);
}

/// What was named, as findings, and what has no name; most important first, what no repair removes
/// last.
void state(const Kept& kept, Problem& problem, const Judges& judges, Diagnosis& diagnosis) {
  const SearchResult& found = kept.found;
  const Selection& selection = kept.selection;
  std::vector<Finding> unproved;
  std::vector<bool> unclear(static_cast<std::size_t>(problem.model().cv_count), false);
  const auto mark_unclear = [&](const Effect& effect) {
    for (const int cv : touched(effect, problem)) unclear[static_cast<std::size_t>(cv)] = true;
  };
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    const Cause& cause = cause_of(effect);
    Finding finding = to_finding(found, i, problem);
    finding.repaired = selection.fates[i] == Fate::kRepaired;
    finding.refused = effect.place.aux >= judges.aux ? "a set-point is no input of a model"
                                                     : why_not_in_model(selection.fates[i]);
    finding.explains = selection.explains[i];
    if (causes::is_unnamed(cause)) {
      diagnosis.unexplained.push_back(to_unexplained(found, i, problem));
      mark_unclear(effect);
    } else if (must_be_proved(effect, judges.aux) && !effect.certain &&
               selection.fates[i] != Fate::kRepaired &&
               !(effect.place.aux >= judges.aux && finding.explains >= kSetpointExplains)) {
      unproved.push_back(std::move(finding));
      mark_unclear(effect);
    } else if (effect.certain || !cause.may_be_nothing(finding)) {
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
  // Where structure is missing what is left is no noise.
  for (const Cause* cause : causes::all())
    for (Finding& finding : cause->left_in(problem, found.fit)) {
      finding.repaired = false;
      if (unclear[static_cast<std::size_t>(finding.subject.place.cv)]) {
        finding.refused = "what is left of the CV is no noise: structure is missing";
        diagnosis.refused.push_back(std::move(finding));
      } else {
        finding.refused = "no repair of a model removes it";
        diagnosis.findings.push_back(std::move(finding));
      }
    }
}

/// The model with all that was repaired. The small corrections that came with the findings have to
/// carry over too, CV by CV.
ModelSpec extended_model(const Problem& problem, const SearchResult& found,
                         const Selection& selection, const ModelSpec& model, const Judges& judges) {
  const std::vector<bool> in = repaired(selection);
  if (std::find(in.begin(), in.end(), true) == in.end()) return model;
  Unseen& unseen = judges.unseen;
  std::vector<bool> keep(static_cast<std::size_t>(model.cv_count), true);
  const ModelSpec with_all = extend(problem, found, in, keep, judges.open);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const CvScore gain = score(unseen.measured(cv), unseen.simulated(model, cv),
                               unseen.simulated(with_all, cv), unseen.block(), unseen.seed());
    if (gain.rmse_after > gain.rmse_before) keep[static_cast<std::size_t>(cv)] = false;
  }
  return extend(problem, found, in, keep, judges.open);
}

/// Whether something was named in a CV, and nothing of that is in the extended model.
bool all_refused(const Kept& kept, const ModelSpec& model, int cv) {
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

/// The smallest share of what a CV does that the model explains beyond a constant, over the CVs
/// that were measured.
double least_explained(const MatrixXd& residuals, const MatrixXd& cvs) {
  const auto variance = [](const VectorXd& values) {
    const double mean = values.mean();
    return (values.array() - mean).square().mean();
  };
  double least = 1.0;
  for (Index cv = 0; cv < cvs.cols(); ++cv) {
    std::vector<double> left, measured;
    for (Index k = 0; k < cvs.rows(); ++k)
      if (std::isfinite(residuals(k, cv))) {
        left.push_back(residuals(k, cv));
        measured.push_back(cvs(k, cv));
      }
    if (left.empty()) continue;
    const auto count = static_cast<Index>(left.size());
    const double all = variance(VectorXd::Map(measured.data(), count));
    if (all > 0.0) least = std::min(least, 1.0 - variance(VectorXd::Map(left.data(), count)) / all);
  }
  return least;
}

void decide(double explained, bool sticks, Diagnosis& diagnosis) {
  const std::ptrdiff_t blind = unknown_gains(diagnosis.channels);
  const bool strong =
      std::any_of(diagnosis.refused.begin(), diagnosis.refused.end(),
                  [](const Finding& finding) { return finding.evidence > kStrongEvidence; });
  diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  if (!diagnosis.findings.empty() || !diagnosis.unexplained.empty())
    diagnosis.verdict = DiagnosisVerdict::kMismatch;
  else if (sticks)
    diagnosis.reason =
        "a loop swings in the shape of a sticking valve, which its model does not explain";
  else if (strong)
    diagnosis.reason = "what explains the samples that were fitted does not hold on the others";
  else if (diagnosis.suspect && diagnosis.suspect->evidence > kStrongEvidence)
    diagnosis.reason =
        "a free run suggests a cause that the calibrated test of the channels does not confirm: "
        "feedback, or a disturbance that wanders, can look the same";
  else if (blind > 0)
    diagnosis.reason = "the inputs move too little beside the noise: the gains of " +
                       std::to_string(blind) + " of " + std::to_string(diagnosis.channels.size()) +
                       " channels are not known to within 25 %";
  else if (explained < kLeastExplained)
    diagnosis.reason = "the model explains less than " + percent_text(kLeastExplained) +
                       " of what a CV does, beyond a constant";
  else
    diagnosis.verdict = DiagnosisVerdict::kMatch;
}

/// CVs whose loop swings as one with a sticking valve does, by shape tests that need no model: of
/// those on which one MV alone acts.
std::vector<int> sticking_loops(const ModelSpec& model, int mvs, const Recording& recording) {
  std::vector<int> loops;
  if (recording.setpoints.cols() == 0) return loops;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    std::vector<int> acting;
    for (const ChannelSpec& channel : model.channels)
      if (channel.cv == cv && channel.input < mvs) acting.push_back(channel.input);
    if (acting.size() != 1 || !recording.setpoints.col(cv).array().isFinite().any()) continue;
    const ValveShape shape =
        judge_valve(recording.inputs.col(acting.front()), recording.cvs.col(cv),
                    recording.setpoints.col(cv), recording.sample_time_s);
    if (shape.verdict == ValveShape::Verdict::kSticks) loops.push_back(cv);
  }
  return loops;
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
    score.horizons.push_back({horizon,
                              std::sqrt(mean_of_finite(unseen.prediction_errors(before, horizon))),
                              std::sqrt(mean_of_finite(unseen.prediction_errors(after, horizon)))});
}

/// Whether the model can be run on the data at all, and every CV was measured now and then.
bool can_be_judged(const MatrixXd& residuals, Diagnosis& diagnosis) {
  for (Index cv = 0; cv < residuals.cols(); ++cv) {
    const auto column = residuals.col(cv);
    double largest = 0.0;
    Index known = 0;
    for (const double value : column)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value)), ++known;
    if (kFewestKnownParts * known >= column.size() && largest < kDiverged) continue;
    diagnosis.reason = largest < kDiverged
                           ? "a CV is unknown, clipped or not to be simulated in most samples"
                           : "the simulation or the measurements diverge";
    return false;
  }
  return true;
}

/// All of diagnose() but for giving up. `settings.progress` is there and throws.
Diagnosis run(const ModelSpec& given, const Recording& measured, const Recording* unseen_runs,
              const DiagnosisSettings& settings) {
  const Recording recording = with_setpoints(measured);
  std::optional<Recording> validation;
  if (unseen_runs != nullptr) validation = with_setpoints(*unseen_runs);
  const auto aux = static_cast<int>(measured.aux.cols());
  const Index samples = recording.samples();
  Diagnosis diagnosis;
  diagnosis.samples = samples;
  diagnosis.fit_samples = validation ? samples : fitted_rows(recording, settings.fit_share);
  diagnosis.validation_samples =
      validation ? validation->samples() : samples - diagnosis.fit_samples;
  diagnosis.extended = given;

  const ModelSpec base = in_channels(given);
  const ModelSpec model = with_aux_inputs(base, recording);
  const Recording fitted = part(recording, 0, diagnosis.fit_samples);
  const MatrixXd residuals = residuals_of(model, recording);
  if (!can_be_judged(residuals, diagnosis)) return diagnosis;
  const ChannelTests tests(with_aux_inputs(base, measured), measured, residuals);
  const std::vector<std::optional<double>> outside = outside_shares(recording, residuals);

  SearchSettings search_settings;
  search_settings.max_findings = settings.max_findings;
  search_settings.progress = settings.progress;
  search_settings.may_name = [&](const Effect& effect) {
    const bool actuator =
        effect.edit == &causes::input_stuck() || effect.edit == &causes::input_offset();
    if (actuator && effect.place.input >= settings.mv_count) return false;  // a DV has none
    return !cause_of(effect).acts_through_channels() || effect.place.aux >= aux ||
           tests.reject(channels_of(effect, model, base.input_count));
  };
  Unseen unseen(validation ? *validation : recording, diagnosis.validation_samples, model,
                settings.seed);
  const Judges judges{
      unseen, aux,
      [&](int cv, int input, bool wrong) {
        // Where only a disturbance was found they soak up what it leaves.
        const auto i = static_cast<std::size_t>(input);
        return tests.reject({{cv, input}}) ||
               (wrong && i < outside.size() && outside[i].value_or(0.0) >= kMostlyOutside);
      },
      outside};
  const Account account = account_for(model, base.input_count, fitted, judges, search_settings);
  Problem& problem = *account.problem;
  const Kept& kept = account.kept;
  diagnosis.channels = estimate_channels(problem, kept.found, search_settings);
  diagnosis.inputs = movements(outside, diagnosis.channels);
  const ModelSpec extended = extended_model(problem, kept.found, kept.selection, model, judges);
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
  const std::vector<bool> in = repaired(kept.selection);
  if (std::find(in.begin(), in.end(), true) != in.end())
    diagnosis.extended = finish(extended, base, diagnosis.new_inputs);
  if (validation) {
    diagnosis.validation_before = std::move(diagnosis.before);
    diagnosis.validation_after = std::move(diagnosis.after);
    Simulator first(recording);
    diagnosis.before = free_runs(first, model);
    diagnosis.after = free_runs(first, extended);
  }
  state(kept, problem, judges, diagnosis);
  if (!validation)
    for (Finding& late :
         find_late(extended, base.input_count, recording, diagnosis.fit_samples, search_settings))
      diagnosis.findings.push_back(std::move(late));
  decide(least_explained(residuals, recording.cvs),
         !sticking_loops(base, settings.mv_count, measured).empty(), diagnosis);
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
  return 3 * kRowsPerNumber * (most + kFreeNoise.order + kOtherNumbers) / 2;
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
