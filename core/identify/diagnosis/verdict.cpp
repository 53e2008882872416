#include "core/identify/diagnosis/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/valves/valve_shape.hpp"
#include "core/text/number_text.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string why_not_judged(const MatrixXd& residuals) {
  for (Index cv = 0; cv < residuals.cols(); ++cv) {
    const auto column = residuals.col(cv);
    double largest = 0.0;
    Index known = 0;
    for (const double value : column)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value)), ++known;
    if (kFewestKnownParts * known >= column.size() && largest < kDiverged) continue;
    return largest < kDiverged ? "a CV is unknown, clipped or not to be simulated in most samples"
                               : "the simulation or the measurements diverge";
  }
  return {};
}

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

bool loses_a_cv(const MatrixXd& residuals, const MatrixXd& cvs, Index first) {
  for (Index cv = 0; cv < cvs.cols(); ++cv) {
    double level = 0.0, before = 0.0, known_before = 0.0;
    for (Index k = 0; k < first; ++k) {
      const double error = residuals(k, cv);
      if (!std::isfinite(error)) continue;
      const double off = error - level;
      level += off / ++known_before;
      before += off * (error - level);
    }
    double mean = 0.0, moved = 0.0, after = 0.0, known_after = 0.0;
    for (Index k = first; k < cvs.rows(); ++k) {
      if (!std::isfinite(residuals(k, cv))) continue;
      const double off = cvs(k, cv) - mean;
      mean += off / ++known_after;
      moved += off * (cvs(k, cv) - mean);
      after += std::pow(residuals(k, cv) - level, 2);
    }
    if (known_before > 0.0 && after > moved && after * known_before > kGrown * before * known_after)
      return true;
  }
  return false;
}

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

void decide(const FreeRunVerdict& free_runs, Diagnosis& diagnosis) {
  const std::ptrdiff_t blind = unknown_gains(diagnosis.channels);
  const auto strongest =
      std::max_element(diagnosis.refused.begin(), diagnosis.refused.end(),
                       [](const Finding& a, const Finding& b) { return a.evidence < b.evidence; });
  const bool strong = strongest != diagnosis.refused.end() && strongest->evidence > kStrongEvidence;
  diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  if (!diagnosis.findings.empty() || !diagnosis.unexplained.empty())
    diagnosis.verdict = DiagnosisVerdict::kMismatch;
  else if (free_runs.sticks)
    diagnosis.reason =
        "a loop swings in the shape of a sticking valve, which its model does not explain";
  else if (strong)
    diagnosis.reason = "what explains most was refused: " + strongest->refused;
  else if (diagnosis.suspect && diagnosis.suspect->evidence > kStrongEvidence)
    diagnosis.reason =
        "a free run suggests a cause that the calibrated test of the channels does not confirm, or "
        "that only feedback shows: it, or a disturbance that wanders, can look the same";
  else if (!diagnosis.rejected.empty())
    diagnosis.reason = "a model that matches would not be rejected so; what is wrong is not told";
  else if (!diagnosis.bent.empty())
    diagnosis.reason =
        "what these channels do no linear model explains; of the known causes none was sure enough";
  else if (blind > 0)
    diagnosis.reason = "the inputs move too little beside the noise: the gains of " +
                       std::to_string(blind) + " of " + std::to_string(diagnosis.channels.size()) +
                       " channels are not known to within 25 %";
  else if (has_gain_off(diagnosis.channels))
    diagnosis.reason = "by its estimate the gain of a channel is off by more than " +
                       percent_text(kSmall.gain) +
                       ", which the calibrated test of the channels does not confirm";
  else if (free_runs.loses)
    diagnosis.reason =
        "in the last samples the model's errors are much larger, and it explains a CV less well "
        "than a constant does; of the known causes none was sure enough";
  else if (free_runs.explained < kLeastExplained)
    diagnosis.reason = "the model explains less than " + percent_text(kLeastExplained) +
                       " of what a CV does, beyond a constant";
  else
    diagnosis.verdict = DiagnosisVerdict::kMatch;
}

}  // namespace mpm
