#include "core/identify/valves/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Where a peak may be, in a half cycle.
constexpr double kFirstPeak = 0.1, kPeakStep = 0.05;
constexpr int kPeaks = 17;
/// Halves of fewer samples have no shape.
constexpr Index kFewestSamples = 5;
/// Ages of a relay's response at its peak, in time constants: from a triangle to a square wave.
constexpr double kAges[] = {0.05, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0};

/// Squared error of the best multiple of a shape, a function of the place 0..1 in the half cycle,
/// as a share of the sum of squares.
template <class Shape>
double error_of(const VectorXd& values, const VectorXd& places, Shape shape) {
  const VectorXd form = places.unaryExpr(shape);
  const double all = values.squaredNorm();
  const double along = values.dot(form);
  return std::max(0.0, 1.0 - along * along / std::max(1e-300, form.squaredNorm() * all));
}

double half_sine(double place) { return std::sin(std::numbers::pi * place); }

double straight(double place, double peak) {
  return place < peak ? place / peak : (1.0 - place) / (1.0 - peak);
}

double rounded(double place, double peak) {
  return std::sin(0.5 * std::numbers::pi * straight(place, peak));
}

/// Rises towards 1 until it is `age` time constants old, then falls towards -1; 0 at both ends.
double relay(double place, double age) {
  const double fall = std::log(2.0 - std::exp(-age));
  const double since = place * (age + fall);
  if (since < age) return 1.0 - std::exp(-since);
  return -1.0 + (2.0 - std::exp(-age)) * std::exp(age - since);
}

/// Calls `take(values, places)` with every half cycle that is long enough.
template <class Take>
void each_half(const Eigen::Ref<const VectorXd>& swing, const std::vector<HalfCycle>& halves,
               Take take) {
  for (const HalfCycle& half : halves) {
    const auto first = static_cast<Index>(std::ceil(half.begin));
    const auto last = static_cast<Index>(std::floor(half.end));
    const Index count = last - first + 1;
    if (count < kFewestSamples || first < 0 || last >= swing.size()) continue;
    const VectorXd values = swing.segment(first, count);
    const VectorXd places = VectorXd::NullaryExpr(count, [&](Index k) {
      return (static_cast<double>(first + k) - half.begin) / (half.end - half.begin);
    });
    take(values, places);
  }
}

}  // namespace

double triangle_index(const Eigen::Ref<const VectorXd>& swing,
                      const std::vector<HalfCycle>& halves) {
  double sines = 0.0, triangles = 0.0;
  each_half(swing, halves, [&](const VectorXd& values, const VectorXd& places) {
    double best_round = 1.0, best_straight = 1.0;
    for (int i = 0; i < kPeaks; ++i) {
      const double peak = kFirstPeak + i * kPeakStep;
      best_round = std::min(
          best_round, error_of(values, places, [peak](double x) { return rounded(x, peak); }));
      best_straight = std::min(
          best_straight, error_of(values, places, [peak](double x) { return straight(x, peak); }));
    }
    sines += best_round;
    triangles += best_straight;
  });
  return sines + triangles > 0.0 ? sines / (sines + triangles) : kNaN;
}

double relay_index(const Eigen::Ref<const VectorXd>& swing, const std::vector<HalfCycle>& halves) {
  double sines = 0.0, relays = 0.0;
  each_half(swing, halves, [&](const VectorXd& values, const VectorXd& places) {
    double best = 1.0;
    for (const double age : kAges)
      best = std::min(best, error_of(values, places, [age](double x) { return relay(x, age); }));
    relays += best;
    sines += error_of(values, places, half_sine);
  });
  return sines + relays > 0.0 ? (sines - relays) / (sines + relays) : kNaN;
}

double resting_index(const Eigen::Ref<const VectorXd>& output,
                     const Eigen::Ref<const VectorXd>& value, double period) {
  const Index lag = std::max<Index>(1, std::lround(0.1 * period));
  const Index rows = output.size() - lag;
  if (rows < 1) return kNaN;
  const VectorXd moves = output.tail(rows) - output.head(rows);
  const VectorXd follows = value.tail(rows) - value.head(rows);
  const auto sd = [](const VectorXd& x) {
    return std::sqrt((x.array() - x.mean()).square().mean());
  };
  const auto moved = (moves.array() - moves.mean()).abs() > sd(moves);
  const auto followed = (follows.array() - follows.mean()).abs() > sd(follows);
  const auto any = static_cast<double>((moved || followed).count());
  const auto resting = static_cast<double>((moved && !followed).count());
  return any > 0.0 ? resting / any : kNaN;
}

}  // namespace mpm
