#include "daemon/report/page/telling_window.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::report {

using Eigen::Index;

Run telling_window(const std::vector<double>& weights, const std::vector<Run>& runs, Index length,
                   const std::vector<Run>& taken) {
  // sums[i]: of the rows before i.
  std::vector<double> sums(weights.size() + 1, 0.0);
  for (std::size_t i = 0; i < weights.size(); ++i)
    sums[i + 1] = sums[i] + (std::isfinite(weights[i]) ? weights[i] : 0.0);
  Run best;
  double most = 0.0;
  for (const Run& run : runs) {
    const Index count = std::min(length, run.count);
    for (Index first = run.first; first + count <= run.first + run.count; ++first) {
      const auto overlaps = [&](const Run& other) {
        return first < other.first + other.count && other.first < first + count;
      };
      const double sum =
          sums[static_cast<std::size_t>(first + count)] - sums[static_cast<std::size_t>(first)];
      if (best.count > 0 && sum <= most) continue;
      if (std::any_of(taken.begin(), taken.end(), overlaps)) continue;
      most = sum;
      best = {first, count};
    }
  }
  return best;
}

Run window_around(Index row, const std::vector<Run>& runs, Index length) {
  for (const Run& run : runs) {
    if (row < run.first || row >= run.first + run.count) continue;
    const Index count = std::min(length, run.count);
    const Index first = std::clamp(row - count / 4, run.first, run.first + run.count - count);
    return {first, count};
  }
  return {};
}

}  // namespace mpm::report
