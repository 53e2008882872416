#include "core/mismatch/curvature.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/mismatch/calibration.hpp"
#include "core/regression/row_feed.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

namespace curvature = calibration::curvature;

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

// How the local gain of channel `a`, relative to the model's, changes with each of the terms'
// coefficients, about its mean over the rows: the mean of the squares, of which
// `coefficients' * that * coefficients` is the variance of that gain.
Eigen::MatrixXd gain_moments(const VolterraTerms& terms, int a, int span) {
  const int inputs = static_cast<int>(terms.inputs().size());
  Eigen::VectorXd slopes(terms.columns()), sum = Eigen::VectorXd::Zero(terms.columns());
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(terms.columns(), terms.columns());
  for (int age = 0; age < span; ++age) {
    slopes.setZero();
    for (int b = 0; b < inputs; ++b)
      for (const int column : terms.product_columns(std::min(a, b), std::max(a, b)))
        slopes(column) = (a == b ? 2.0 : 1.0) * terms.contribution(b, age);
    for (const int column : terms.cube_columns(a))
      slopes(column) = 3.0 * terms.contribution(a, age) * terms.contribution(a, age);
    sum += slopes;
    square.selfadjointView<Eigen::Lower>().rankUpdate(slopes);
  }
  square.selfadjointView<Eigen::Lower>().rankUpdate(sum, -1.0 / span);
  return Eigen::MatrixXd(square.selfadjointView<Eigen::Lower>()) / span;
}

double bounded_variation(double square) {
  return square > 0.0 ? std::min(2.0 * std::sqrt(square), curvature::kMostVariation) : 0.0;
}

// For terms of which the coefficients are R^-1 `rotated`, with the covariance `variance`
// R^-1 R^-T, relative to `own`. That covariance C alone makes tr(M C) of a variance b'M b of the
// gain, which in turn has the variance 4 b'M C M b + 2 tr(M C M C) (Searle 1971, 2.5).
void set_variation(const Eigen::MatrixXd& moments, const Eigen::MatrixXd& triangle,
                   const Eigen::VectorXd& rotated, double variance, double own,
                   Curvature::Channel& channel) {
  const auto upper = triangle.triangularView<Eigen::Upper>();
  const Eigen::VectorXd coefficients = upper.solve(rotated);
  // R^-T M R^-1, which has the traces of M C and its powers.
  const Eigen::MatrixXd half = upper.transpose().solve(moments);
  const Eigen::MatrixXd errors = variance * upper.transpose().solve(half.transpose());
  const double square = coefficients.dot(moments * coefficients) - errors.trace();
  const Eigen::VectorXd slope = upper.transpose().solve(moments * coefficients);
  const double deviation =
      std::sqrt(4.0 * variance * slope.squaredNorm() + 2.0 * errors.squaredNorm());
  channel.gain_variation = bounded_variation(square / (own * own));
  channel.sure_variation =
      bounded_variation((square - kNormalOneSided99 * deviation) / (own * own));
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
  if (freedom < curvature::kFreedomPerColumn * count) return std::nullopt;
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
  const double own = std::max(1.0 - past.sum(), curvature::kLeastOwnGain);

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
    set_variation(gain_moments(terms, a, span), triangle, rotated, variance, own, channel);
  }
  return found;
}

}  // namespace mpm
