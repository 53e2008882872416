#include "core/mismatch/curvature.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/regression/row_feed.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

namespace limits = calibration::curvature;

// What the terms still say where those with channel `a` in them are left out; and how many go.
double explained_by(const VolterraTerms& terms, int a, const Eigen::MatrixXd& triangle,
                    const Eigen::VectorXd& rotated, int& left_out) {
  std::vector<Eigen::Index> kept;
  for (int c = 0; c < terms.columns(); ++c)
    if (!terms.has(c, a)) kept.push_back(c);
  left_out = terms.columns() - static_cast<int>(kept.size());
  if (kept.empty()) return rotated.squaredNorm();
  Eigen::MatrixXd others(triangle.rows(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t c = 0; c < kept.size(); ++c)
    others.col(static_cast<Eigen::Index>(c)) = triangle.col(kept[c]);
  const Eigen::VectorXd fitted = others * others.colPivHouseholderQr().solve(rotated);
  return (rotated - fitted).squaredNorm();
}

// Two s.d. of the local gain of channel `a`, relative to the model's.
double gain_variation(const VolterraTerms& terms, int a, const Eigen::VectorXd& coefficients,
                      int first, double own, int span) {
  const int count = static_cast<int>(terms.inputs().size());
  const auto coefficient = [&](const std::array<int, 2>& columns) {
    return (coefficients(first + columns[0]) + coefficients(first + columns[1])) / own;
  };
  std::vector<double> slopes;
  slopes.reserve(terms.inputs().size());
  for (int b = 0; b < count; ++b)
    slopes.push_back((a == b ? 2.0 : 1.0) *
                     coefficient(terms.product_columns(std::min(a, b), std::max(a, b))));
  const double bend = 3 * coefficient(terms.cube_columns(a));
  double sum = 0.0, square = 0.0;
  for (int age = 0; age < span; ++age) {
    double change = bend * terms.contribution(a, age) * terms.contribution(a, age);
    for (int b = 0; b < count; ++b)
      change += slopes[static_cast<std::size_t>(b)] * terms.contribution(b, age);
    sum += change;
    square += change * change;
  }
  const double variance = std::max(square - sum * sum / span, 0.0) / span;
  return std::min(2.0 * std::sqrt(variance), limits::kMostVariation);
}

}  // namespace

std::optional<Curvature> find_curvature(const RegressionShape& shape, int cv,
                                        const RegressionHistory& history,
                                        const ResidualRegression& regression,
                                        const VolterraTerms& terms) {
  const int first = shape.columns();
  const int count = terms.columns();
  const int span = std::min(regression.span(), history.settled());
  if (count == 0 || span < first + count) return std::nullopt;
  GivensQr factor(first + count, 1);
  RowFeed feed(first + count + 1);
  double rows = 0.0;
  for (int age = span - 1; age >= 0; --age) {
    const double weight = regression.row_weight(age);
    if (!(weight > 0.0)) continue;
    double* row = feed.next_row(factor);
    regression.fill(history, age, row);
    terms.fill(age, row + first);
    row[first + count] = history.residual(cv, age);
    for (int c = 0; c <= first + count; ++c) row[c] *= weight;
    rows += regression.row_share(age);
  }
  feed.flush(factor);
  const double freedom = rows - first - count;
  if (freedom < limits::kFreedomPerColumn * count) return std::nullopt;
  const double variance = factor.residual_square(0) / freedom;
  if (!(variance > 0.0)) return std::nullopt;

  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd rotated(count);
  for (int r = 0; r < count; ++r) {
    for (int c = r; c < count; ++c) triangle(r, c) = factor.r(first + r, first + c);
    rotated(r) = factor.z(first + r, 0);
  }
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(first + count);
  factor.solve(0, first + count, coefficients);
  Eigen::VectorXd past(shape.past());
  shape.own_past(cv, coefficients, past);
  const double own = std::max(1.0 - past.sum(), limits::kLeastOwnGain);

  Curvature found;
  found.channels.resize(static_cast<std::size_t>(shape.inputs));
  found.explained = rotated.squaredNorm() / variance;
  found.p_value = f_upper_tail(found.explained / count, count, freedom);
  for (int a = 0; a < static_cast<int>(terms.inputs().size()); ++a) {
    int left_out = 0;
    const double explained = explained_by(terms, a, triangle, rotated, left_out) / variance;
    Curvature::Channel& channel =
        found.channels[static_cast<std::size_t>(terms.inputs()[static_cast<std::size_t>(a)])];
    channel.p_value = f_upper_tail(explained / left_out, left_out, freedom);
    channel.gain_variation = gain_variation(terms, a, coefficients, first, own, span);
  }
  return found;
}

}  // namespace mpm
