#include "core/identify/diagnosis/late.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"
#include "core/identify/diagnosis/statement.hpp"
#include "core/identify/diagnosis/undecided.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr const char* kNotJudged =
    "it began in the samples on which repairs are measured, or shortly before them";

double mean_square(const CvData& data, const VectorXd& residual, Index first, Index count) {
  const double known = data.known.segment(first, count).sum();
  return known > 0.0 ? residual.segment(first, count).squaredNorm() / known : 0.0;
}

bool grew(const Problem& problem, const Fit& fit, Index first) {
  return std::any_of(fit.cvs.begin(), fit.cvs.end(), [&](const CvFit& cv) {
    const CvData& data = problem.data(cv.cv);
    return mean_square(data, cv.residual, first, problem.samples() - first) >
           kGrown * mean_square(data, cv.residual, 0, first);
  });
}

/// The row from which on an effect counts as late.
Index late_from(Index first) {
  return first - static_cast<Index>(kLateMargin * static_cast<double>(first));
}

}  // namespace

Late find_late(const ModelSpec& model, int model_inputs, const Recording& recording, Index first,
               const SearchSettings& asked) {
  Problem problem(model, model_inputs, recording, Tolerances{},
                  free_noise(model, model_inputs, recording));
  std::vector<int> cvs(static_cast<std::size_t>(model.cv_count));
  std::iota(cvs.begin(), cvs.end(), 0);
  SearchResult found;
  found.fit = problem.fit({}, 0, cvs);
  if (!std::isfinite(found.fit.cost)) return {};
  const Index from = late_from(first);
  if (grew(problem, found.fit, first)) {
    SearchSettings settings = asked;
    settings.max_findings = kMostLate;
    settings.shown = settings.suspects = false;
    settings.may_name = [&](const Effect& effect) {
      return effect.onset >= from && (!asked.may_name || asked.may_name(effect));
    };
    found = search(problem, settings);
  }
  Late late;
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Effect& effect = found.named[i].effect;
    const Cause& cause = cause_of(effect);
    // No rows are left that could prove more than a wrong number.
    if (causes::is_unnamed(cause) || cause.is_input_block() || effect.onset < from) continue;
    Finding finding = to_finding(found, i, problem);
    if (cause.may_be_nothing(finding)) continue;
    finding.late = true;
    finding.repaired = false;
    const char* other = causes::passes(effect) && found.named[i].evidence < kStrongEvidence
                            ? kNotBorneOut
                            : why_not_step(effect, found.named, model, recording);
    finding.refused = other != nullptr ? other : kNotJudged;
    (other != nullptr ? late.doubted : late.findings).push_back(std::move(finding));
  }
  const double begin = problem.surroundings().start_s +
                       static_cast<double>(from) * problem.surroundings().sample_time_s;
  for (const Cause* cause : causes::all())
    for (Finding& finding : cause->left_in(problem, found.fit)) {
      if (!finding.refused.empty() || *finding.onset_s < begin) continue;
      finding.repaired = false;
      finding.refused = kNotJudged;
      late.findings.push_back(std::move(finding));
    }
  return late;
}

Late begun_late(const ModelSpec& model, const ModelSpec& tested, const Recording& recording,
                const Recording& measured, Index first, const SignalRanges& ranges,
                const std::vector<std::optional<double>>& outside_shares, SearchSettings settings) {
  const Index from = late_from(first), rest = recording.samples() - from;
  const Eigen::MatrixXd residuals = free_run_residuals(model, recording);
  const ChannelTests before(tested, part(measured, 0, from), residuals.topRows(from));
  const ChannelTests since(tested, part(measured, from, rest), residuals.bottomRows(rest));
  // These rows are mostly too few for the nonlinear test.
  const auto may_name = nameable(model, ranges, since, since, outside_shares);
  settings.may_name = [&](const Effect& effect) {
    if (effect.place.aux >= ranges.aux || !may_name(effect)) return false;
    if (!cause_of(effect).acts_through_channels()) return true;
    const auto channels = channels_of(effect, model, ranges.inputs);
    return since.reject(channels, kBeyondDoubt) && !before.reject(channels, kBeyondDoubt);
  };
  Late late = find_late(model, ranges.inputs, recording, first, settings);
  // Taken in, so that no other cause is named for it; told only where it may matter.
  std::erase_if(late.findings, [&](const Finding& finding) {
    const Place& place = finding.subject.place;
    return finding.subject.cause->together_with_others() != nullptr &&
           !since.may_matter({{place.cv, place.input}});
  });
  return late;
}

bool may_be_refused(const Finding& late, const std::vector<Effect>& refused,
                    const ModelSpec& model) {
  if (!accuses(late.subject) || !late.subject.cause->acts_through_channels()) return false;
  Effect accused;
  accused.edit = late.subject.cause;
  accused.place = late.subject.place;
  for (int cv = 0; cv < model.cv_count; ++cv)
    if (touches(accused, model, cv) &&
        std::any_of(refused.begin(), refused.end(), [&](const Effect& effect) {
          return cause_of(effect).acts_through_channels() && touches(effect, model, cv);
        }))
      return true;
  return false;
}

}  // namespace mpm
