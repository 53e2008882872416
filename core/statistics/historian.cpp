#include "core/statistics/historian.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/statistics/calibration.hpp"
#include "core/statistics/compression.hpp"
#include "core/statistics/reading_spacings.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double lattice(const std::vector<double>& levels, double range) {
  double quantum = range;
  for (std::size_t i = 1; i < levels.size(); ++i)
    quantum = std::min(quantum, levels[i] - levels[i - 1]);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double steps = (levels[i] - levels[i - 1]) / quantum;
    if (std::abs(steps - std::round(steps)) > kOfLattice * std::max(1.0, steps)) return 0.0;
  }
  return quantum;
}

struct Line {
  double start = 0.0, slope = 0.0;
};

/// Least squares; weights 0 or 1.
Line line_through(const VectorXd& x, const VectorXd& y, const VectorXd& weight) {
  const double count = weight.sum(), mean_x = weight.dot(x) / count, mean_y = weight.dot(y) / count;
  const VectorXd from_mean = weight.cwiseProduct(x - VectorXd::Constant(x.size(), mean_x));
  const double slope = from_mean.dot(y) / from_mean.dot(x);
  return {mean_y - slope * mean_x, slope};
}

/// Values that differ by rounding are one.
std::vector<double> levels_of(std::vector<double> values, double tie) {
  std::sort(values.begin(), values.end());
  const auto same = [tie](double a, double b) { return b - a <= tie; };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
  return values;
}

/// Where another value than the last known one stands; the first that is known, too.
std::vector<Index> reading_rows(const Eigen::Ref<const VectorXd>& values) {
  std::vector<Index> rows;
  double last = 0.0;
  for (Index k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values(k)) || (!rows.empty() && values(k) == last)) continue;
    rows.push_back(k);
    last = values(k);
  }
  return rows;
}

}  // namespace

Index reading_interval(const Eigen::Ref<const VectorXd>& values) {
  const std::vector<Index> rows = reading_rows(values);
  std::vector<std::int64_t> spacings;
  for (std::size_t i = 1; i < rows.size(); ++i) spacings.push_back(rows[i] - rows[i - 1]);
  if (spacings.size() < readings::kFewest) return 0;
  const ReadingSpacings found = reading_spacings(spacings);
  return found.regular >= readings::kRegular ? found.every : 0;
}

double reading_cycle(const Eigen::Ref<const VectorXd>& values) {
  const auto every = static_cast<double>(reading_interval(values));
  if (every == 0.0 || reading_offset(values, every)) return every;
  // No whole number of rows: what the readings' rows rise by with their numbers.
  std::vector<Index> rows = reading_rows(values);
  rows.erase(rows.begin());  // what stands at first was read before
  std::vector<std::int64_t> spacings;
  for (std::size_t i = 1; i < rows.size(); ++i) spacings.push_back(rows[i] - rows[i - 1]);
  const double near = reading_spacings(spacings).mean;
  VectorXd at(static_cast<Index>(rows.size())), number(at.size());
  for (Index i = 0; i < at.size(); ++i) {
    at(i) = static_cast<double>(rows[static_cast<std::size_t>(i)]);
    number(i) = i == 0 ? 0.0 : number(i - 1) + std::round((at(i) - at(i - 1)) / near);
  }
  const Line all = line_through(number, at, VectorXd::Ones(at.size()));
  // Once more without what came between two readings.
  const VectorXd off = at - all.slope * number - VectorXd::Constant(at.size(), all.start);
  const double slope =
      line_through(number, at, (off.array().abs() < readings::kOffLine).cast<double>()).slope;
  return slope > 1.0 ? slope : every;  // NaN where none is near
}

std::optional<double> reading_offset(const Eigen::Ref<const VectorXd>& values, double every) {
  std::vector<Index> rows = reading_rows(values);
  if (rows.size() < 2) return std::nullopt;
  rows.erase(rows.begin());  // what stands at first was read before
  std::vector<double> phases;
  for (const Index row : rows) phases.push_back(std::fmod(static_cast<double>(row), every));
  std::sort(phases.begin(), phases.end());
  const std::size_t count = phases.size();
  for (std::size_t i = 0; i < count; ++i) phases.push_back(phases[i] + every);
  // The latest of those that belong together, so that none is missed: in a cycle of no whole number
  // of rows they come up to a row after it, in a long one up to a row late.
  const bool whole = every == std::round(every);
  const double width = whole && every < static_cast<double>(readings::kJitterFrom) ? 0.0 : 1.0;
  std::size_t first = 0, most = 0;
  double latest = 0.0;
  for (std::size_t last = 0; last < phases.size(); ++last) {
    while (phases[last] - phases[first] > width) ++first;
    const std::size_t together = std::min(count, last - first + 1);
    if (together > most) most = together, latest = phases[last];
  }
  const bool regular = static_cast<double>(most) >= readings::kRegular * static_cast<double>(count);
  return regular ? std::optional(std::fmod(latest, every)) : std::nullopt;
}

HistorianTraits historian_traits(const Eigen::Ref<const VectorXd>& values) {
  HistorianTraits traits;
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  if (known.size() < kFewestRows) return traits;
  const auto [low, high] = std::minmax_element(known.begin(), known.end());
  const double range = *high - *low, rows = static_cast<double>(known.size());
  if (!(range > 0.0)) return traits;
  double mean = 0.0, square = 0.0;
  for (const double value : known) mean += value / rows;
  for (const double value : known) square += (value - mean) * (value - mean) / rows;
  traits.sd = std::sqrt(square);

  traits.read_every = reading_interval(values);
  Compression compression;
  for (const double value : known) compression.take(value);
  compression.conclude();
  traits.interpolated = compression.kind() == Compression::Kind::kInterpolated;
  if (compression.kind() == Compression::Kind::kHeld)
    traits.deadband = compression.smallest_change();

  const double tie = kTie * range;
  std::vector<double> moves;
  double held = 0.0, on_line = 0.0, last = 0.0;
  for (Index k = 1; k < values.size(); ++k) {
    const double move = values(k) - values(k - 1);
    if (!std::isfinite(move)) continue;
    if (std::abs(move) <= tie)
      ++held;
    else
      moves.push_back(std::abs(move));
    on_line += Compression::straight(move, last) ? 1.0 : 0.0;
    last = move;
  }
  traits.held_share = held / rows;
  traits.straight_share = on_line / rows;
  if (traits.compressed() || traits.held_share < kHeldShare || moves.size() < kFewestSteps)
    return traits;

  const std::vector<double> levels = levels_of(known, tie);
  if (levels.size() < kFewestLevels) return traits;
  const double quantum = lattice(levels, range);
  const auto of_one = std::count_if(
      moves.begin(), moves.end(), [quantum](double move) { return move < kOneQuantum * quantum; });
  if (static_cast<double>(of_one) >= kNeighbours * static_cast<double>(moves.size()))
    traits.quantum = quantum;
  return traits;
}

bool beyond_use(const HistorianTraits& traits) {
  return (traits.interpolated && traits.straight_share > kMuch) ||
         traits.deadband > kMuch * traits.sd || traits.quantum > kMuch * traits.sd;
}

}  // namespace mpm
