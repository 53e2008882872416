#include "core/identify/causes/square_wave_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/identify/fit/misfit_slope.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFewestCycles = 3.0;
constexpr double kShortestPeriod = 16.0;  ///< rows
constexpr double kFineRows = 3000.0;      ///< more rows than these are looked at in longer strides
constexpr std::size_t kWaves = 4;         ///< of each onset
constexpr std::array<double, 3> kOnsets = {0.0, 0.25, 0.5};

/// How much of the innovations +1, -1, +1, ... explains, for any period and phase. What whitening
/// makes of such a wave is a short pulse at each edge, so no edge may be missed by a row: all are
/// tried, on running sums, which takes as many steps as the wave has edges.
class MatchedFilter {
 public:
  MatchedFilter(const CvData& data, const CvFit& fit) : rows_(fit.innovations.size()) {
    const VectorXd slope = misfit_slope(data, fit);
    sums_.setZero(rows_ + 1);
    for (Index k = 0; k < rows_; ++k) sums_(k + 1) = sums_(k) + slope(k);
    // Squares of the whitened wave: so much in every row, so much more at every edge.
    const VectorXd& a = fit.noise.coefficients;
    const double level = 1.0 - a.sum();
    level_ = level * level / fit.variance;
    double passed = 1.0;
    for (Index l = 0; l < a.size(); ++l) {
      edge_ += (std::pow(2.0 * passed - level, 2) - level * level) / fit.variance;
      passed -= a(l);
    }
    edge_ = std::max(edge_, 0.0);
  }

  [[nodiscard]] double gain(double begin, double period, Index onset) const {
    const double half = 0.5 * period;
    double edge = begin, sum = 0.0, sign = 1.0;
    while (edge > static_cast<double>(onset)) edge -= half, sign = -sign;
    double edges = 0.0;
    Index from = onset;
    for (edge += half; from < rows_; edge += half, sign = -sign, edges += 1.0) {
      const Index to = std::min(rows_, static_cast<Index>(std::ceil(edge)));
      sum += sign * (sums_(to) - sums_(from));
      from = to;
    }
    const double norm = level_ * static_cast<double>(rows_ - onset) + edge_ * edges;
    return norm > 0.0 ? sum * sum / norm : 0.0;
  }

 private:
  Index rows_;
  VectorXd sums_;
  double level_ = 0.0, edge_ = 0.0;
};

/// The best few, no two of nearly one period, and how many were looked at.
std::vector<SquareWave> best_waves(const MatchedFilter& filter, Index samples, Index onset,
                                   std::size_t& looked_at) {
  const auto length = static_cast<double>(samples - onset);
  const double stride = std::max(1.0, static_cast<double>(samples) / kFineRows);
  std::vector<SquareWave> best;
  double period = kShortestPeriod * stride;
  while (period <= length / kFewestCycles) {
    SquareWave wave{0.0, 0.0, period, onset};
    const auto phases = static_cast<int>(std::ceil(0.5 * period / stride));
    for (int phase = 0; phase < phases; ++phase) {
      const double begin = static_cast<double>(onset) + phase * stride;
      const double gain = filter.gain(begin, period, onset);
      if (gain > wave.gain) wave.gain = gain, wave.begin = begin;
    }
    looked_at += static_cast<std::size_t>(phases);
    const auto near = std::find_if(best.begin(), best.end(), [&](const SquareWave& other) {
      return std::abs(other.period / period - 1.0) < 0.02;
    });
    if (near != best.end()) {
      if (wave.gain > near->gain) *near = wave;
    } else {
      best.push_back(wave);
    }
    std::sort(best.begin(), best.end(),
              [](const SquareWave& a, const SquareWave& b) { return a.gain > b.gain; });
    if (best.size() > kWaves) best.pop_back();
    period += stride * period / length;  // the last edge by a row
  }
  return best;
}

}  // namespace

SquareWaves find_square_waves(const CvData& data, const CvFit& without) {
  const Index samples = without.innovations.size();
  const MatchedFilter filter(data, without);
  SquareWaves found;
  for (const double share : kOnsets) {
    const std::vector<SquareWave> some = best_waves(
        filter, samples, static_cast<Index>(share * static_cast<double>(samples)), found.looked_at);
    found.waves.insert(found.waves.end(), some.begin(), some.end());
  }
  return found;
}

}  // namespace mpm
