#include "core/identify/fit/row_weights.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/identify/fit/calibration.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Median of |x| of a normal variable, in s.d.
constexpr double kMedian = 0.6744897501960817;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

VectorXd rows_with_past(const Eigen::Ref<const VectorXd>& known, const std::vector<Run>& runs,
                        Index past) {
  VectorXd rows = known;
  for (const auto& [first, count] : runs)
    rows.segment(first, std::min<Index>(past, count)).setZero();
  for (Index k = 0; k < known.size(); ++k)
    if (known(k) == 0.0) rows.segment(k, std::min<Index>(past + 1, known.size() - k)).setZero();
  return rows;
}

double usual_sd(const Eigen::Ref<const VectorXd>& innovations,
                const Eigen::Ref<const VectorXd>& weights) {
  std::vector<double> sizes;
  for (Index k = 0; k < innovations.size(); ++k)
    if (weights(k) > 0.0) sizes.push_back(std::abs(innovations(k)));
  return sizes.empty() ? 0.0 : median(sizes) / kMedian;
}

void reweigh(const Eigen::Ref<const VectorXd>& innovations, VectorXd& weights) {
  const Index rows = innovations.size();
  // The local s.d. at every kHalfWindow / 2 rows, between them linear.
  constexpr Index kStride = kHalfWindow / 2;
  std::vector<double> scales;
  std::vector<double> window;
  for (Index centre = 0; centre < rows + kStride; centre += kStride) {
    window.clear();
    const Index begin = std::max<Index>(0, std::min(centre, rows) - kHalfWindow);
    const Index end = std::min(rows, centre + kHalfWindow);
    for (Index k = begin; k < end; ++k)
      if (weights(k) > 0.0) window.push_back(std::abs(innovations(k)));
    scales.push_back(
        static_cast<Index>(window.size()) < kFewestInWindow ? 0.0 : median(window) / kMedian);
  }
  const double usual = usual_sd(innovations, weights);
  if (!(usual > 0.0)) return;
  for (double& scale : scales)
    if (!(scale > kQuietest * usual)) scale = scale > 0.0 ? kQuietest * usual : usual;
  double total = 0.0, count = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (weights(k) == 0.0) continue;
    const auto left = static_cast<std::size_t>(k / kStride);
    const double share = static_cast<double>(k % kStride) / static_cast<double>(kStride);
    const double scale =
        (1.0 - share) * scales[left] + share * scales[std::min(left + 1, scales.size() - 1)];
    const double robust = std::min(1.0, kClip * scale / std::max(1e-300, std::abs(innovations(k))));
    weights(k) = robust * robust * usual * usual / (scale * scale);
    total += weights(k);
    ++count;
  }
  if (total > 0.0) weights *= count / total;
}

}  // namespace mpm
