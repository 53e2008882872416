#include "core/identify/fit/plateau.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/identify/fit/calibration.hpp"

namespace mpm {
namespace {

struct End {
  double level = 0.0;
  double share = 0.0;
  bool plateau = false;
};

/// `sorted`: from the end in question on.
End look(const std::vector<double>& sorted) {
  const double range = std::abs(sorted.front() - sorted.back());
  const double tie = kPlateauTie * range;
  std::vector<std::size_t> multiplicities;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= sorted.size() && multiplicities.size() <= kPlateauOthers; ++i) {
    if (i < sorted.size() && std::abs(sorted[i] - sorted[begin]) <= tie) continue;
    multiplicities.push_back(i - begin);
    begin = i;
  }
  End end;
  if (multiplicities.size() <= kPlateauOthers) return end;  // two-level signals and the like
  const std::size_t others = *std::max_element(multiplicities.begin() + 1, multiplicities.end());
  const std::size_t count = multiplicities.front();
  end.level = sorted.front();
  end.share = static_cast<double>(count) / static_cast<double>(sorted.size());
  end.plateau =
      count >= kPlateauRows && end.share >= kPlateauShare && count > kPlateauExcess * others;
  return end;
}

/// How often the values came to a level after they had been well away from it.
int visits(const Eigen::Ref<const Eigen::VectorXd>& values, double level, double range) {
  int count = 0;
  bool away = true;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    const double distance = std::abs(value - level);
    if (distance > kPlateauLeft * range) away = true;
    if (distance > kPlateauTie * range) continue;
    count += away ? 1 : 0;
    away = false;
  }
  return count;
}

}  // namespace

Plateaus find_plateaus(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  Plateaus plateaus;
  if (sorted.size() < kFewestForPlateau) return plateaus;
  std::sort(sorted.begin(), sorted.end());
  const End low = look(sorted);
  std::reverse(sorted.begin(), sorted.end());
  const End high = look(sorted);
  const double range = sorted.front() - sorted.back();
  plateaus.tie = kPlateauTie * range;
  const auto clips = [&](const End& end) {
    return end.plateau && visits(values, end.level, range) >= kPlateauVisits;
  };
  if (clips(low)) plateaus.low = low.level, plateaus.low_share = low.share;
  if (clips(high)) plateaus.high = high.level, plateaus.high_share = high.share;
  return plateaus;
}

}  // namespace mpm
