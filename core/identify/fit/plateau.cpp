#include "core/identify/fit/plateau.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

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
  const double tie = 1e-9 * range;
  std::vector<std::size_t> multiplicities;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= sorted.size() && multiplicities.size() < 11; ++i) {
    if (i < sorted.size() && std::abs(sorted[i] - sorted[begin]) <= tie) continue;
    multiplicities.push_back(i - begin);
    begin = i;
  }
  End end;
  if (multiplicities.size() < 11) return end;  // two-level signals and the like
  const std::size_t others = *std::max_element(multiplicities.begin() + 1, multiplicities.end());
  const std::size_t count = multiplicities.front();
  end.level = sorted.front();
  end.share = static_cast<double>(count) / static_cast<double>(sorted.size());
  end.plateau = count >= 8 && end.share >= 0.005 && count > 5 * others;
  return end;
}

}  // namespace

Plateaus find_plateaus(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  Plateaus plateaus;
  if (sorted.size() < 100) return plateaus;
  std::sort(sorted.begin(), sorted.end());
  const End low = look(sorted);
  std::reverse(sorted.begin(), sorted.end());
  const End high = look(sorted);
  if (low.plateau) plateaus.low = low.level, plateaus.low_share = low.share;
  if (high.plateau) plateaus.high = high.level, plateaus.high_share = high.share;
  return plateaus;
}

}  // namespace mpm
