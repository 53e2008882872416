#include "core/statistics/historian.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/statistics/calibration.hpp"
#include "core/statistics/compression.hpp"

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

/// By how many rows a reading may come late.
Index jitter_of(Index every) { return every >= readings::kJitterFrom ? 1 : 0; }

}  // namespace

Index reading_interval(const Eigen::Ref<const VectorXd>& values) {
  const std::vector<Index> rows = reading_rows(values);
  std::vector<Index> spacings;
  for (std::size_t i = 1; i < rows.size(); ++i) spacings.push_back(rows[i] - rows[i - 1]);
  if (spacings.size() < readings::kFewest) return 0;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  const Index every = *middle;
  if (every < 2) return 0;
  // Two readings that are equal, and one that is missing, make a multiple.
  const Index jitter = jitter_of(every);
  const auto regular = std::count_if(spacings.begin(), spacings.end(), [&](Index spacing) {
    const Index nearest = std::max<Index>(1, (spacing + every / 2) / every) * every;
    return std::abs(spacing - nearest) <= jitter;
  });
  return static_cast<double>(regular) >= readings::kRegular * static_cast<double>(spacings.size())
             ? every
             : 0;
}

std::optional<Index> reading_offset(const Eigen::Ref<const VectorXd>& values, Index every) {
  std::vector<Index> rows = reading_rows(values);
  if (rows.size() < 2) return std::nullopt;
  rows.erase(rows.begin());  // what stands at first was read before
  std::vector<std::size_t> at(static_cast<std::size_t>(every), 0);
  for (const Index row : rows) ++at[static_cast<std::size_t>(row % every)];
  // The latest of those that belong together, so that none is missed.
  const Index jitter = jitter_of(every);
  const auto count = [&](Index row) { return at[static_cast<std::size_t>(row % every)]; };
  Index best = 0;
  std::size_t most = 0;
  for (Index last = 0; last < every; ++last) {
    const std::size_t all = count(last) + (jitter > 0 ? count(last + every - jitter) : 0);
    if (count(last) > 0 && all > most) most = all, best = last;
  }
  const bool regular =
      static_cast<double>(most) >= readings::kRegular * static_cast<double>(rows.size());
  return regular ? std::optional(best) : std::nullopt;
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
