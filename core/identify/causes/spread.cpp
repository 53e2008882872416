#include "core/identify/causes/spread.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace mpm {

std::optional<Spread> spread_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  constexpr std::size_t kFewest = 20;
  Spread spread;
  for (const double value : values)
    if (std::isfinite(value)) spread.sorted.push_back(value);
  if (spread.sorted.size() < kFewest) return std::nullopt;
  std::sort(spread.sorted.begin(), spread.sorted.end());
  spread.low = spread.quantile(0.01);
  spread.high = spread.quantile(0.99);
  spread.median = spread.quantile(0.5);
  double mean = 0.0, square = 0.0;
  for (const double value : spread.sorted) mean += value;
  mean /= static_cast<double>(spread.sorted.size());
  for (const double value : spread.sorted) square += (value - mean) * (value - mean);
  spread.sd = std::sqrt(square / static_cast<double>(spread.sorted.size()));
  if (!(spread.high > spread.low)) return std::nullopt;
  return spread;
}

int Spread::levels() const {
  constexpr double kStep = 0.02;  // of the range: nearer values are one
  constexpr double kMost = 0.95;  // of the values: the rest tells too little
  std::vector<double> held;
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto end = std::upper_bound(first, sorted.end(), *first + kStep * range());
    held.push_back(static_cast<double>(end - first));
    first = end;
  }
  std::sort(held.begin(), held.end(), std::greater<>());
  const double enough = kMost * static_cast<double>(sorted.size());
  int count = 0;
  for (double sum = 0.0; sum < enough; ++count) sum += held[static_cast<std::size_t>(count)];
  return count;
}

}  // namespace mpm
