#include "core/identify/causes/noise_change.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace mpm {

using Eigen::Index;

namespace {

/// Rows with a weight that a change can be told from, and on either side of it.
constexpr double kFewestRows = 200.0, kFewestOnOneSide = 50.0;
/// Innovations below this share of their s.d. count as so large: a log has no bottom.
constexpr double kFloor = 1e-3;
/// s.d. that the best of all moments must reach: of pure noise it stays below 4.5 in all but 1 of
/// 1000 recordings or so (tests/core/identify/causes/noise_change_test.cpp).
constexpr double kBeyondDoubt = 5.0;
/// Half of a 95 % interval, s.d.
constexpr double kReach = 1.96;

double mean_of(const double* values, std::size_t count) {
  return std::accumulate(values, values + count, 0.0) / static_cast<double>(count);
}

/// How many times the s.d. of a mean is what it would be of levels that know nothing of each other,
/// at least 1: from means over blocks of sqrt(n), beside a step before `place`. What a historian
/// holds and lets go, and what a missing curve leaves, comes in bursts.
double burstiness(const std::vector<double>& levels, std::size_t place) {
  const auto block = static_cast<std::size_t>(std::sqrt(static_cast<double>(levels.size())));
  double of_means = 0.0, within = 0.0, blocks = 0.0, rows = 0.0;
  const auto add = [&](std::size_t begin, std::size_t end) {
    const double middle = mean_of(&levels[begin], end - begin);
    for (std::size_t i = begin; i < end; ++i, rows += 1.0)
      within += (levels[i] - middle) * (levels[i] - middle);
    for (; begin + block <= end; begin += block, blocks += 1.0) {
      const double off = mean_of(&levels[begin], block) - middle;
      of_means += off * off;
    }
  };
  add(0, place);
  add(place, levels.size());
  if (blocks <= 2.0 || within == 0.0) return 1.0;
  const double ratio =
      static_cast<double>(block) * (of_means / (blocks - 2.0)) / (within / (rows - 2.0));
  return std::sqrt(std::max(1.0, ratio));
}

}  // namespace

std::optional<NoiseChange> find_noise_change(const CvFit& fit, const CvData& data, double least) {
  // log |innovation|: its s.d. is 1.11 for a normal one and hardly more for heavy tails, so
  // outliers do not decide. Its mean moves by half the log of the variance ratio.
  std::vector<double> levels;
  std::vector<Index> rows;
  const double floor = kFloor * std::sqrt(fit.variance);
  for (Index k = 0; k < fit.innovations.size(); ++k) {
    if (data.weights(k) == 0.0) continue;
    levels.push_back(std::log(std::max(floor, std::abs(fit.innovations(k)))));
    rows.push_back(k);
  }
  const auto count = static_cast<double>(levels.size());
  if (count < kFewestRows) return std::nullopt;
  double total = 0.0, square = 0.0;
  for (const double level : levels) total += level, square += level * level;
  double sum = 0.0, best = 0.0, best_difference = 0.0;
  std::size_t place = 0;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    sum += levels[i];
    const double before = static_cast<double>(i + 1), after = count - before;
    if (before < kFewestOnOneSide || after < kFewestOnOneSide) continue;
    const double difference = (total - sum) / after - sum / before;
    const double within =
        (square - sum * sum / before - (total - sum) * (total - sum) / after) / (count - 2.0);
    const double z = difference / std::sqrt(std::max(1e-12, within) * (1.0 / before + 1.0 / after));
    if (std::abs(z) > std::abs(best)) best = z, best_difference = difference, place = i + 1;
  }
  if (std::abs(best) < kBeyondDoubt) return std::nullopt;
  NoiseChange change;
  change.burstiness = burstiness(levels, place);
  best /= change.burstiness;
  change.onset = rows[place];
  change.ratio = std::exp(2.0 * best_difference);
  change.z = best;
  const double sd = std::abs(2.0 * best_difference / best);
  change.low = std::exp(2.0 * best_difference - kReach * sd);
  change.high = std::exp(2.0 * best_difference + kReach * sd);
  if (change.ratio < least && change.ratio > 1.0 / least) return std::nullopt;
  return change;
}

bool NoiseChange::beyond_doubt() const { return std::abs(z) >= kBeyondDoubt; }

}  // namespace mpm
