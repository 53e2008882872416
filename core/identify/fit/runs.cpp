#include "core/identify/fit/runs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;

Index longest_gap(const ModelSpec& model) {
  const ModelSpec channels = in_channels(model);
  double slowest_s = kShortestLongGap * model.sample_time_s;
  for (int cv = 0; cv < channels.cv_count; ++cv)
    slowest_s = std::max(slowest_s, slowest_of_cv_s(channels, cv, kShortestLongGap));
  return static_cast<Index>(std::ceil(slowest_s / model.sample_time_s));
}

Index longest_loss() { return static_cast<Index>(kShortestLongGap); }

namespace {

// Where `values` are unknown for too long: rows that have no CV either are a gap, not a loss.
std::vector<Run> losses(const Eigen::Ref<const Eigen::VectorXd>& values, const MatrixXd& cvs) {
  std::vector<Run> found;
  Run stretch;
  Index beside = 0;  // rows of it that have a CV
  for (Index k = 0; k <= values.size(); ++k) {
    if (k < values.size() && !std::isfinite(values(k))) {
      if (stretch.count++ == 0) stretch.first = k;
      beside += cvs.row(k).array().isFinite().any() ? 1 : 0;
      continue;
    }
    if (beside > longest_loss()) found.push_back(stretch);
    stretch.count = beside = 0;
  }
  return found;
}

}  // namespace

Recording without_lost_inputs(Recording recording) {
  std::vector<bool> lost(static_cast<std::size_t>(recording.samples()), false);
  for (Index i = 0; i < recording.inputs.cols(); ++i) {
    const std::vector<Run> found = losses(recording.inputs.col(i), recording.cvs);
    Index rows = 0;
    for (const Run& loss : found) rows += loss.count;
    if (2 * rows > recording.samples()) continue;
    for (const auto& [first, count] : found) std::fill_n(lost.begin() + first, count, true);
  }
  if (std::find(lost.begin(), lost.end(), true) == lost.end()) return recording;
  std::vector<Recording> runs;
  for (const auto& [first, count] : runs_of(recording))
    for (Index k = first, end = first + count; k < end;) {
      Index next = k;
      while (next < end &&
             lost[static_cast<std::size_t>(next)] == lost[static_cast<std::size_t>(k)])
        ++next;
      if (!lost[static_cast<std::size_t>(k)]) runs.push_back(part(recording, k, next - k));
      k = next;
    }
  return runs.empty() ? part(recording, 0, 0) : joined(runs);
}

Recording without_scraps(const Recording& recording) {
  if (recording.borders.empty()) return recording;
  std::vector<Recording> runs;
  for (const auto& [first, count] : runs_of(recording))
    if (count >= kShortestRun) runs.push_back(part(recording, first, count));
  return runs.empty() ? part(recording, 0, 0) : joined(runs);
}

}  // namespace mpm
