#include "core/statistics/level_change.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/statistics/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

// value = level + slope * shape(point), by weighted least squares.
struct Fit {
  double level = 0.0, slope = 0.0;
  double square = 0.0;  // weighted, of what it leaves
  double spread = 0.0;  // weighted, of the shape about its mean
};

double weight_of(const LevelPoint& point) {
  return point.deviation > 0.0 ? 1.0 / (point.deviation * point.deviation) : 1.0;
}

// What is added to the level, in units of the slope.
double shape_of(std::span<const LevelPoint> points, bool gradual, std::size_t first,
                std::size_t i) {
  if (!gradual) return i >= first ? 1.0 : 0.0;
  const double whole = points.back().at - points[first].at;
  return std::max(0.0, points[i].at - points[first].at) / whole;
}

Fit fit(std::span<const LevelPoint> points, bool gradual, std::size_t first) {
  double sum = 0.0, mean_value = 0.0, mean_shape = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = weight_of(points[i]);
    sum += weight;
    mean_value += weight * points[i].value;
    mean_shape += weight * shape_of(points, gradual, first, i);
  }
  mean_value /= sum;
  mean_shape /= sum;
  Fit found;
  double product = 0.0, values = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = weight_of(points[i]);
    const double value = points[i].value - mean_value;
    const double shape = shape_of(points, gradual, first, i) - mean_shape;
    found.spread += weight * shape * shape;
    product += weight * shape * value;
    values += weight * value * value;
  }
  found.slope = product / found.spread;
  found.level = mean_value - found.slope * mean_shape;
  found.square = std::max(0.0, values - found.slope * product);
  return found;
}

// Of neighbours in what a fit leaves, 0 or more; a fit through few points makes it too small, which
// is made up for.
double resemblance(std::span<const LevelPoint> points, const LevelChange& change, const Fit& fit) {
  std::vector<double> rest;
  for (std::size_t i = 0; i < points.size(); ++i)
    rest.push_back(std::sqrt(weight_of(points[i])) *
                   (points[i].value - fit.level -
                    fit.slope * shape_of(points, change.gradual, change.first, i)));
  double square = 0.0, product = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    square += rest[i] * rest[i];
    if (i > 0) product += rest[i] * rest[i - 1];
  }
  const double plain = square > 0.0 ? product / square : 0.0;
  const double missing = (level_change::kLostPoints + level_change::kLostShare * plain) /
                         static_cast<double>(rest.size());
  return std::clamp(plain + missing, 0.0, level_change::kMostResemblance);
}

}  // namespace

std::optional<LevelChange> find_level_change(std::span<const LevelPoint> points) {
  const std::size_t count = points.size();
  if (count < level_change::kFewestPoints) return std::nullopt;
  LevelChange change;
  Fit best;
  int tried = 0;
  const auto attempt = [&](bool gradual, std::size_t first) {
    const Fit candidate = fit(points, gradual, first);
    if (tried++ > 0 && candidate.square >= best.square) return;
    best = candidate;
    change.gradual = gradual;
    change.first = first;
  };
  for (std::size_t first = 1; first < count; ++first) attempt(false, first);
  for (std::size_t first = 0; first + 2 < count; ++first) attempt(true, first);

  const double correlation = resemblance(points, change, best);
  const double counted = (1.0 - correlation) / (1.0 + correlation);
  const auto freedom = static_cast<double>(count - 2);
  const double scatter = best.square / freedom / counted;
  const bool known = std::all_of(points.begin(), points.end(),
                                 [](const LevelPoint& point) { return point.deviation > 0.0; });
  // Of the two the larger one; where that is the scatter, which few points tell badly, with their
  // freedom.
  const double variance = std::max(known ? 1.0 : 0.0, scatter);
  const double certain = known && scatter <= 1.0 ? level_change::kKnown
                         : known                 ? freedom
                                                 : std::max(1.0, freedom * counted);
  const double explained = best.slope * best.slope * best.spread;
  const double of_one = variance > 0.0 ? f_upper_tail(explained / variance, 1.0, certain)
                                       : (explained > 0.0 ? 0.0 : 1.0);
  change.p_value = std::min(1.0, tried * of_one);
  change.before = best.level;
  change.after = best.level + best.slope;
  change.deviation = std::sqrt(variance / best.spread);
  return change;
}

}  // namespace mpm
