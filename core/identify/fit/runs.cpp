#include "core/identify/fit/runs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;

Index longest_gap(const ModelSpec& model) {
  const ModelSpec channels = in_channels(model);
  double slowest_s = kShortestLongGap * model.sample_time_s;
  for (int cv = 0; cv < channels.cv_count; ++cv)
    slowest_s = std::max(slowest_s, slowest_of_cv_s(channels, cv, kShortestLongGap));
  return static_cast<Index>(std::ceil(slowest_s / model.sample_time_s));
}

Recording without_scraps(const Recording& recording) {
  if (recording.borders.empty()) return recording;
  std::vector<Recording> runs;
  for (const auto& [first, count] : runs_of(recording))
    if (count >= kShortestRun) runs.push_back(part(recording, first, count));
  return runs.empty() ? part(recording, 0, 0) : joined(runs);
}

}  // namespace mpm
