#include "core/identify/valves/oscillation.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Crossings of the autocorrelation that are looked at: later ones are of few pairs.
constexpr std::size_t kMostCrossings = 11;
constexpr std::size_t kFewestCrossings = 4;
/// Longest lag, as a share of the data.
constexpr double kLongestLag = 0.5;
/// Of the s.d. of a swing: what it must pass for its sign to count.
constexpr double kHysteresis = 0.3;
constexpr double kShortestHalf = 0.25, kLongestHalf = 0.75;  ///< periods

/// Where a straight line between two neighbours is 0.
double crossing(double before, double after, Index at) {
  return static_cast<double>(at) + before / (before - after);
}

VectorXd without_line(const Eigen::Ref<const VectorXd>& values) {
  const Index rows = values.size();
  const VectorXd x = VectorXd::LinSpaced(rows, -1.0, 1.0);
  const double slope = x.dot(values) / x.squaredNorm();
  const double mean = values.mean();
  return values.array() - mean - slope * x.array();
}

}  // namespace

Oscillation oscillation_of(const Eigen::Ref<const VectorXd>& values) {
  const VectorXd x = without_line(values);
  const Index rows = x.size();
  const auto longest = static_cast<Index>(kLongestLag * static_cast<double>(rows));
  std::vector<double> crossings;
  double before = x.squaredNorm();
  for (Index lag = 1; lag <= longest && crossings.size() < kMostCrossings; ++lag) {
    const double now = x.head(rows - lag).dot(x.tail(rows - lag));
    if ((before > 0.0) != (now > 0.0)) crossings.push_back(crossing(before, now, lag - 1));
    before = now;
  }
  if (crossings.size() < kFewestCrossings) return {};
  std::vector<double> periods;  // the first crossing is half an interval from lag 0
  for (std::size_t i = 1; i < crossings.size(); ++i)
    periods.push_back(2.0 * (crossings[i] - crossings[i - 1]));
  const auto count = static_cast<double>(periods.size());
  double sum = 0.0, square = 0.0;
  for (const double period : periods) sum += period;
  const double mean = sum / count;
  for (const double period : periods) square += (period - mean) * (period - mean);
  const double sd = std::sqrt(square / std::max(1.0, count - 1.0));
  return {mean, mean / (3.0 * std::max(sd, 1e-9 * mean))};
}

VectorXd swing_of(const Eigen::Ref<const VectorXd>& values, double period) {
  const Index rows = values.size();
  // Towards the ends as much as there is on both sides.
  VectorXd sums(rows + 1);
  sums(0) = 0.0;
  for (Index k = 0; k < rows; ++k) sums(k + 1) = sums(k) + values(k);
  const auto half = std::max<Index>(1, std::lround(0.5 * period));
  VectorXd swing(rows);
  for (Index k = 0; k < rows; ++k) {
    const Index first = std::clamp<Index>(k - half, 0, std::max<Index>(0, rows - 2 * half));
    const Index last = std::min(rows, first + 2 * half);
    swing(k) = values(k) - (sums(last) - sums(first)) / static_cast<double>(last - first);
  }
  return swing;
}

std::vector<HalfCycle> half_cycles(const Eigen::Ref<const VectorXd>& swing, double period) {
  const Index rows = swing.size();
  const double level = kHysteresis * std::sqrt(swing.squaredNorm() / static_cast<double>(rows));
  // The last crossing before the signal has passed the level on the other side.
  std::vector<double> crossings;
  int sign = 0;
  double last = 0.0;
  bool crossed = false;
  for (Index k = 0; k < rows; ++k) {
    if (k > 0 && (swing(k - 1) > 0.0) != (swing(k) > 0.0)) {
      last = crossing(swing(k - 1), swing(k), k - 1);
      crossed = true;
    }
    const int now = swing(k) > level ? 1 : swing(k) < -level ? -1 : 0;
    if (now == 0 || now == sign) continue;
    if (sign != 0 && crossed) crossings.push_back(last);
    sign = now;
  }
  std::vector<HalfCycle> halves;
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    const double length = crossings[i] - crossings[i - 1];
    if (length > kShortestHalf * period && length < kLongestHalf * period)
      halves.push_back({crossings[i - 1], crossings[i]});
  }
  return halves;
}

}  // namespace mpm
