#include "core/identify/causes/square_wave_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/identify/fit/misfit_slope.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSquareWaveSearchFewestCycles = 3.0;
constexpr double kShortestPeriod = 16.0;  ///< rows
/// More rows than these are looked at in longer strides: at so many a search takes some 0.15 s.
constexpr double kFineRows = 6000.0;
constexpr std::size_t kWaves = 4;  ///< of each onset
constexpr std::array<double, 3> kSquareWaveSearchOnsets = {0.0, 0.25, 0.5};

/// How much of the innovations +1, -1, +1, ... explains, for any period and phase. What whitening
/// makes of such a wave is a short pulse at each edge, so no edge may be missed by a row: all are
/// tried, on running sums, which takes as many steps as the wave has edges. Lengths and places are
/// in strides.
class MatchedFilter {
 public:
  MatchedFilter(const CvData& data, const CvFit& fit, double stride) {
    const VectorXd slope = misfit_slope(data, fit);
    const Index rows = slope.size();
    end_ = static_cast<Index>(std::ceil(static_cast<double>(rows) / stride));
    sums_.setZero(end_ + 1);
    double sum = 0.0;
    Index row = 0;
    for (Index at = 1; at <= end_; ++at) {
      const auto to = static_cast<Index>(std::ceil(static_cast<double>(at) * stride));
      for (; row < std::min(to, rows); ++row) sum += slope(row);
      sums_(at) = sum;
    }
    // Squares of the whitened wave: so much in every row, so much more at every edge.
    const VectorXd& a = fit.noise.coefficients;
    const double level = 1.0 - a.sum();
    level_ = stride * level * level / fit.variance;
    double passed = 1.0;
    for (Index l = 0; l < a.size(); ++l) {
      edge_ += (std::pow(2.0 * passed - level, 2) - level * level) / fit.variance;
      passed -= a(l);
    }
    edge_ = std::max(edge_, 0.0);
  }

  [[nodiscard]] Index end() const { return end_; }

  struct Gains {
    VectorXd of_phase, edges;
  };
  /// Of the waves of this period that begin with a rising edge at onset, onset + 1, ... within half
  /// a period.
  void gains(double period, Index onset, Gains& result) const {
    auto& [gains, edges] = result;
    const double half = 0.5 * period;
    const auto phases = static_cast<Index>(std::ceil(half));
    // The sum over what lies between two edges is a difference of running sums, so the running sum
    // at an edge counts twice. Those of all phases lie side by side.
    gains.setConstant(phases, -sums_(onset));
    edges.setZero(phases);
    edges(0) = -1.0;  // the one at the onset is none
    double sign = 1.0;
    Index open = phases;  // those that have not come to the end, the first ones
    for (auto edge = static_cast<double>(onset); open > 0; edge += half, sign = -sign) {
      const auto first = static_cast<Index>(std::ceil(edge));
      const Index on = std::clamp<Index>(end_ - first, 0, open);
      gains.segment(on, open - on).array() += sign * sums_(end_);
      gains.head(on) += 2.0 * sign * sums_.segment(std::min(first, end_), on);
      edges.head(on).array() += 1.0;
      open = on;
    }
    for (Index phase = 0; phase < phases; ++phase) {
      const double norm = level_ * static_cast<double>(end_ - onset) + edge_ * (edges(phase) + 1.0);
      const double gain = gains(phase) * gains(phase) / norm;
      gains(phase) = gain > 0.0 && norm > 0.0 ? gain : 0.0;
    }
  }

 private:
  Index end_ = 0;
  VectorXd sums_;
  double level_ = 0.0, edge_ = 0.0;
};

/// Of waves that begin at `onset` (in strides): the best few, no two of nearly one period, and how
/// many were looked at.
SquareWaves best_waves(const MatchedFilter& filter, double stride, Index onset) {
  const auto length = static_cast<double>(filter.end() - onset);
  SquareWaves found;
  std::vector<SquareWave>& best = found.waves;
  MatchedFilter::Gains gains;
  double period = kShortestPeriod;
  while (period <= length / kSquareWaveSearchFewestCycles) {
    filter.gains(period, onset, gains);
    Index phase = 0;
    SquareWave wave;
    wave.gain = gains.of_phase.maxCoeff(&phase);
    wave.begin = stride * static_cast<double>(onset + phase);
    wave.period = stride * period;
    wave.onset = static_cast<Index>(stride * static_cast<double>(onset));
    found.looked_at += static_cast<std::size_t>(gains.of_phase.size());
    const auto near = std::find_if(best.begin(), best.end(), [&](const SquareWave& other) {
      return std::abs(other.period / wave.period - 1.0) < 0.02;
    });
    if (near != best.end()) {
      if (wave.gain > near->gain) *near = wave;
    } else {
      best.push_back(wave);
    }
    std::sort(best.begin(), best.end(),
              [](const SquareWave& a, const SquareWave& b) { return a.gain > b.gain; });
    if (best.size() > kWaves) best.pop_back();
    period += period / length;  // the last edge by a stride
  }
  return found;
}

}  // namespace

SquareWaves find_square_waves(const CvData& data, const CvFit& without, const Parallel& parallel) {
  const auto samples = static_cast<double>(without.innovations.size());
  const double stride = std::max(1.0, samples / kFineRows);
  const MatchedFilter filter(data, without, stride);
  std::array<SquareWaves, kSquareWaveSearchOnsets.size()> of_each;
  parallel.for_each(kSquareWaveSearchOnsets.size(), [&](std::size_t i) {
    const auto onset = static_cast<Index>(kSquareWaveSearchOnsets[i] * samples / stride);
    of_each[i] = best_waves(filter, stride, onset);
  });
  SquareWaves found;
  for (const SquareWaves& some : of_each) {
    found.waves.insert(found.waves.end(), some.waves.begin(), some.waves.end());
    found.looked_at += some.looked_at;
  }
  return found;
}

}  // namespace mpm
