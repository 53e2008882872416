#include "core/nonlinear/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/nonlinear/calibration.hpp"

namespace mpm {
namespace {

// Before any member is built from it.
RankCorrelation::Shape checked(const RankCorrelation::Shape& shape) {
  if (shape.inputs < 1 || shape.cvs < 1 || shape.last_lag < 0 || shape.first_lag > shape.last_lag)
    throw std::invalid_argument("impossible shape of the rank correlation");
  return shape;
}

// What is left of a coefficient's square.
double root(double left) {
  return left > calibration::nonlinear_rounding::kLeftOfRanks ? std::sqrt(left) : 0.0;
}

}  // namespace

RankCorrelation::RankCorrelation(const Shape& shape, int length)
    : shape_(checked(shape)),
      window_rows_(shape.last_lag + std::max(0, -shape.first_lag) + 1),
      window_(shape.inputs + shape.cvs * lag_count(), length),
      row_(window_.signals()),
      correlations_(Eigen::MatrixXd::Zero(lag_count(), shape.inputs * shape.cvs)),
      coefficients_(shape.inputs, window_.signals()),
      factor_(shape.inputs, shape.inputs),
      left_(shape.inputs) {
  for (int i = 0; i < shape.inputs; ++i) input_windows_.emplace_back(window_rows_);
  for (int j = 0; j < shape.cvs; ++j) residual_windows_.emplace_back(window_rows_);
  order_.reserve(static_cast<std::size_t>(shape.inputs));
}

void RankCorrelation::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                             const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  for (int i = 0; i < shape_.inputs; ++i)
    input_windows_[static_cast<std::size_t>(i)].push(inputs(i));
  for (int j = 0; j < shape_.cvs; ++j)
    residual_windows_[static_cast<std::size_t>(j)].push(residuals(j));
  filled_ = std::min(filled_ + 1, window_rows_);
  if (filled_ < window_rows_) return;
  double* out = row_.data();
  for (const LagWindow& input : input_windows_) *out++ = input.window()[shape_.last_lag];
  for (const LagWindow& residual : residual_windows_)
    out = std::reverse_copy(residual.window(), residual.window() + lag_count(), out);
  window_.push(row_);
}

void RankCorrelation::archive(Archive& a) {
  // not archived: shape_, window_rows_ (construction)
  // not archived: row_, coefficients_, factor_, order_, left_ (empty between calls)
  a.within(filled_, 0, window_rows_);
  a(input_windows_, residual_windows_, window_, correlations_);
}

void RankCorrelation::evaluate() {
  const int lags = lag_count();
  for (int i = 0; i < shape_.inputs; ++i)
    for (int s = 0; s < window_.signals(); ++s) coefficients_(i, s) = window_.coefficient(i, s);
  for (int i = 0; i < shape_.inputs; ++i) {
    if (shape_.partial) hold_others(i);
    for (int j = 0; j < shape_.cvs; ++j)
      for (int l = 0; l < lags; ++l) {
        const int signal = shape_.inputs + j * lags + l;
        correlations_(l, i * shape_.cvs + j) =
            shape_.partial ? beside_others(signal) : coefficients_(i, signal);
      }
  }
}

// The factor L of the inputs' coefficients, this input's last: what is left of it is L(m, m).
void RankCorrelation::hold_others(int input) {
  order_.clear();
  for (int o = 0; o < shape_.inputs; ++o)
    if (o != input) order_.push_back(o);
  order_.push_back(input);
  for (int row = 0; row < shape_.inputs; ++row)
    for (int column = 0; column <= row; ++column) {
      const int a = order_[static_cast<std::size_t>(row)];
      const int b = order_[static_cast<std::size_t>(column)];
      const double left =
          coefficients_(a, b) - factor_.row(row).head(column).dot(factor_.row(column).head(column));
      const double pivot = column == row ? 1.0 : factor_(column, column);
      factor_(row, column) = column == row ? root(left) : pivot > 0.0 ? left / pivot : 0.0;
    }
}

// One more row of that factor, of the signal: its part along what is left of the input, against
// all that is left of it.
double RankCorrelation::beside_others(int signal) {
  const int last = shape_.inputs - 1;
  double square = 1.0;
  for (int column = 0; column <= last; ++column) {
    const double left = coefficients_(order_[static_cast<std::size_t>(column)], signal) -
                        factor_.row(column).head(column).dot(left_.head(column));
    const double pivot = factor_(column, column);
    left_(column) = pivot > 0.0 ? left / pivot : 0.0;
    if (column < last) square -= left_(column) * left_(column);
  }
  const double all = root(square);
  return all > 0.0 ? std::clamp(left_(last) / all, -1.0, 1.0) : 0.0;
}

}  // namespace mpm
