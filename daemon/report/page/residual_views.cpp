#include "daemon/report/page/residual_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mpm::report {
namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
}

double rms(const double* values, std::size_t count) {
  double sum = 0.0, known = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    if (std::isfinite(values[i])) {
      sum += values[i] * values[i];
      known += 1.0;
    }
  return known > 0.0 ? std::sqrt(sum / known) : kNaN;
}

std::vector<double> block_rms(const std::vector<double>& values, std::size_t block) {
  std::vector<double> result;
  for (std::size_t start = 0; start < values.size(); start += block)
    result.push_back(rms(values.data() + start, std::min(block, values.size() - start)));
  return result;
}

LevelBins level_bins(const std::vector<double>& level, std::size_t parts) {
  std::vector<int> order;
  for (std::size_t i = 0; i < level.size(); ++i)
    if (std::isfinite(level[i])) order.push_back(static_cast<int>(i));
  const auto value = [&](int row) { return level[static_cast<std::size_t>(row)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return value(a) < value(b); });
  LevelBins bins;
  std::size_t start = 0;
  for (std::size_t part = 1; part <= parts && start < order.size(); ++part) {
    std::size_t end = std::max(start, part * order.size() / parts);
    // Equal levels stay together: a set-point that rests is one part.
    while (end > start && end < order.size() && value(order[end]) == value(order[end - 1])) ++end;
    if (end == start) continue;
    bins.samples.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(start),
                              order.begin() + static_cast<std::ptrdiff_t>(end));
    const std::vector<int>& rows = bins.samples.back();
    const double sum = std::accumulate(rows.begin(), rows.end(), 0.0,
                                       [&](double total, int row) { return total + value(row); });
    bins.level.push_back(sum / static_cast<double>(rows.size()));
    start = end;
  }
  return bins;
}

LevelView over_levels(const LevelBins& bins, const std::vector<double>& values) {
  LevelView view;
  for (const std::vector<int>& rows : bins.samples) {
    double sum = 0.0, squares = 0.0, known = 0.0;
    for (const int row : rows) {
      const double value = values[static_cast<std::size_t>(row)];
      if (!std::isfinite(value)) continue;
      sum += value;
      squares += value * value;
      known += 1.0;
    }
    view.rms.push_back(known > 0.0 ? std::sqrt(squares / known) : kNaN);
    view.mean.push_back(known > 0.0 ? sum / known : kNaN);
  }
  return view;
}

}  // namespace mpm::report
