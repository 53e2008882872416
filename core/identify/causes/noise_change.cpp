#include "core/identify/causes/noise_change.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mpm {

using Eigen::Index;

std::optional<NoiseChange> find_noise_change(const CvFit& fit, const CvData& data, double least) {
  // log |innovation|: its s.d. is 1.11 for a normal one and hardly more for heavy tails, so
  // outliers do not decide. Its mean moves by half the log of the variance ratio.
  std::vector<double> levels;
  std::vector<Index> rows;
  const double floor = 1e-3 * std::sqrt(fit.variance);
  for (Index k = 0; k < fit.innovations.size(); ++k) {
    if (data.weights(k) == 0.0) continue;
    levels.push_back(std::log(std::max(floor, std::abs(fit.innovations(k)))));
    rows.push_back(k);
  }
  const auto count = static_cast<double>(levels.size());
  if (count < 200.0) return std::nullopt;
  double total = 0.0, square = 0.0;
  for (const double level : levels) total += level, square += level * level;
  double sum = 0.0, best = 0.0, best_difference = 0.0;
  std::size_t place = 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    sum += levels[i];
    const double before = static_cast<double>(i + 1), after = count - before;
    if (before < 50.0 || after < 50.0) continue;
    const double difference = (total - sum) / after - sum / before;
    const double within =
        (square - sum * sum / before - (total - sum) * (total - sum) / after) / (count - 2.0);
    const double z = difference / std::sqrt(std::max(1e-12, within) * (1.0 / before + 1.0 / after));
    if (std::abs(z) > std::abs(best)) best = z, best_difference = difference, place = i + 1;
  }
  NoiseChange change;
  change.onset = place > 0 ? rows[place] : 0;
  change.ratio = std::exp(2.0 * best_difference);
  change.z = best;
  const double sd = best != 0.0 ? std::abs(2.0 * best_difference / best) : 0.0;
  change.low = std::exp(2.0 * best_difference - 1.96 * sd);
  change.high = std::exp(2.0 * best_difference + 1.96 * sd);
  // The best of all moments of pure noise stays below 4.5 in all but 1 of 1000 recordings or so.
  if (std::abs(best) < 5.0 || (change.ratio < least && change.ratio > 1.0 / least))
    return std::nullopt;
  return change;
}

}  // namespace mpm
