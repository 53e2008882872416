#include "core/identify/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/clock.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/diagnosis/unseen.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/split.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Thrown where the caller's `progress` says so; ends all loops at once.
struct GivenUp {};

std::function<bool(double)> or_give_up(const std::function<bool(double)>& progress) {
  return [&progress](double share) {
    if (progress && !progress(share)) throw GivenUp();
    return true;
  };
}

/// What was named, as findings, and what has no name; most important first.
void state(const SearchResult& found, const Selection& selection, Problem& problem,
           Diagnosis& diagnosis) {
  std::vector<Finding> all;
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    all.push_back(to_finding(found, i, problem));
    all.back().repaired = selection.fates[i] == Fate::kRepaired;
    if (causes::is_unnamed(*all.back().subject.cause))
      diagnosis.unexplained.push_back(to_unexplained(found, i, problem));
    else if (selection.fates[i] != Fate::kRefused)
      diagnosis.findings.push_back(all.back());
  }
  for (const std::size_t i : selection.order)
    if (selection.fates[i] == Fate::kRefused) diagnosis.refused.push_back(all[i]);
  for (const Cause* cause : causes::all())
    for (Finding& finding : cause->left_in(problem, found.fit))
      diagnosis.findings.push_back(std::move(finding));
  std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.evidence > b.evidence; });
}

/// The model with all that was repaired. The small corrections that came with the findings have to
/// carry over too, CV by CV.
ModelSpec extended_model(const Problem& problem, const SearchResult& found,
                         const Selection& selection, const ModelSpec& model, Unseen& unseen) {
  const std::vector<bool> in = repaired(selection);
  if (std::find(in.begin(), in.end(), true) == in.end()) return model;
  std::vector<bool> keep(static_cast<std::size_t>(model.cv_count), true);
  const ModelSpec with_all = extend(problem, found, in, keep);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const CvScore gain = score(unseen.measured(cv), unseen.simulated(model, cv),
                               unseen.simulated(with_all, cv), unseen.block(), unseen.seed());
    if (gain.rmse_after > gain.rmse_before) keep[static_cast<std::size_t>(cv)] = false;
  }
  return extend(problem, found, in, keep);
}

/// Whether something was named in a CV, and nothing of that is in the extended model.
bool all_refused(const SearchResult& found, const Selection& selection, const ModelSpec& model,
                 int cv) {
  bool tried = false;
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    if (causes::is_unnamed(cause_of(effect)) || !touches(effect, model, cv)) continue;
    if (selection.fates[i] == Fate::kRepaired) return false;
    tried = true;
  }
  return tried;
}

void decide(Diagnosis& diagnosis) {
  const std::ptrdiff_t blind = unknown_gains(diagnosis.channels);
  const bool strong =
      std::any_of(diagnosis.refused.begin(), diagnosis.refused.end(),
                  [](const Finding& finding) { return finding.evidence > kStrongEvidence; });
  diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  if (!diagnosis.findings.empty() || !diagnosis.unexplained.empty())
    diagnosis.verdict = DiagnosisVerdict::kMismatch;
  else if (strong)
    diagnosis.reason = "what explains the samples that were fitted does not hold on the others";
  else if (blind > 0)
    diagnosis.reason = "the inputs move too little beside the noise: the gains of " +
                       std::to_string(blind) + " of " + std::to_string(diagnosis.channels.size()) +
                       " channels are not known to within 25 %";
  else
    diagnosis.verdict = DiagnosisVerdict::kMatch;
}

/// All of diagnose() but for giving up. `settings.progress` is there and throws.
Diagnosis run(const ModelSpec& given, const Recording& recording, const Recording* validation,
              const DiagnosisSettings& settings) {
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
  SearchSettings search_settings;
  search_settings.max_findings = settings.max_findings;
  search_settings.progress = settings.progress;
  const Explained explained = explain(model, base.input_count, fitted, search_settings);
  Problem& problem = *explained.problem;
  const SearchResult& found = explained.found;
  diagnosis.channels = estimate_channels(problem, found, search_settings);

  Unseen unseen(validation ? *validation : recording, diagnosis.validation_samples, model,
                settings.seed);
  const Selection selection = select(problem, found, unseen, [&] { settings.progress(kSearched); });
  const ModelSpec extended = extended_model(problem, found, selection, model, unseen);
  diagnosis.before = unseen.free_runs(model);
  diagnosis.after = unseen.free_runs(extended);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const Index rows = unseen.rows();
    diagnosis.scores.push_back(score(unseen.measured(cv), diagnosis.before.col(cv).tail(rows),
                                     diagnosis.after.col(cv).tail(rows), unseen.block(),
                                     unseen.seed() + static_cast<std::uint64_t>(cv)));
    diagnosis.scores.back().refused = all_refused(found, selection, model, cv);
  }
  const std::vector<bool> in = repaired(selection);
  if (std::find(in.begin(), in.end(), true) != in.end())
    diagnosis.extended = finish(extended, base, diagnosis.new_inputs);
  if (validation) {
    diagnosis.validation_before = std::move(diagnosis.before);
    diagnosis.validation_after = std::move(diagnosis.after);
    Simulator first(recording);
    diagnosis.before = free_runs(first, model);
    diagnosis.after = free_runs(first, extended);
  }
  state(found, selection, problem, diagnosis);
  decide(diagnosis);
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
