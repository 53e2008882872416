#include "core/identify/diagnosis/measured_gain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/validation.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double slowest_samples(const ModelSpec& model) {
  double slowest = 1.0;
  for (const ChannelSpec& channel : model.channels)
    slowest = std::max(slowest, slowest_time_constant_s(channel, model.sample_time_s));
  return slowest / model.sample_time_s;
}

}  // namespace

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
    bool repaired = false, tried = false;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const Effect& effect = found.named[i].effect;
      if (effect.subject.cause == Cause::kUnnamed || !touches(effect, model, cv)) continue;
      (in[i] ? repaired : tried) = true;
    }
    result.refused = tried && !repaired;
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

}  // namespace mpm
