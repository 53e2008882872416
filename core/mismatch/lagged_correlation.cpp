#include "core/mismatch/lagged_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"

namespace mpm {
namespace {

constexpr double kTiny = std::numeric_limits<double>::min();

// Before any member is built from it.
LaggedCorrelation::Shape checked(LaggedCorrelation::Shape shape, double lambda) {
  if (shape.inputs < 1 || shape.cvs < 1 || shape.controlling_lags < 0 || shape.last_lag < 0 ||
      shape.first_lag > shape.last_lag || !(lambda > 0.0 && lambda <= 1.0) || of_ranks(shape.kind))
    throw std::invalid_argument("impossible shape of the lagged correlation");
  if (shape.kind == CorrelationKind::kPartial || shape.kind == CorrelationKind::kConventional)
    shape.controlling_lags = 0;
  return shape;
}

}  // namespace

LaggedCorrelation::LaggedCorrelation(const Shape& shape, double lambda)
    : shape_(checked(shape, lambda)),
      lambda_(lambda),
      block_columns_(shape_.kind == CorrelationKind::kLaggedPartial ? shape_.controlling_lags + 1
                                                                    : 1),
      window_rows_(shape_.last_lag + std::max(shape_.controlling_lags, -shape_.first_lag) + 1),
      origin_(Eigen::VectorXd::Zero(shape.inputs)),
      correlations_(Eigen::MatrixXd::Zero(lag_count(), shape.inputs * shape.cvs)),
      defined_(static_cast<std::size_t>(shape.inputs), false) {
  const int responses = shape.cvs * lag_count();
  const int shared_past =
      shape_.kind == CorrelationKind::kAlternative ? shape.inputs * shape_.controlling_lags : 0;
  if (!conventional())
    factors_.emplace_back(1 + shared_past, shape.inputs, block_columns_, responses, lambda);
  for (int i = 0; i < shape.inputs; ++i) {
    input_windows_.emplace_back(window_rows_);
    if (conventional()) factors_.emplace_back(1, 1, 1, responses, lambda);
  }
  for (int j = 0; j < shape.cvs; ++j) residual_windows_.emplace_back(window_rows_);
  totals_.assign(static_cast<std::size_t>(shape.inputs), 0.0);
}

void LaggedCorrelation::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                               const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  if (!has_origin_) {
    origin_ = inputs;
    has_origin_ = true;
  }
  for (int i = 0; i < shape_.inputs; ++i)
    input_windows_[static_cast<std::size_t>(i)].push(inputs(i) - origin_(i));
  for (int j = 0; j < shape_.cvs; ++j)
    residual_windows_[static_cast<std::size_t>(j)].push(residuals(j));
  filled_ = std::min(filled_ + 1, window_rows_);
  if (filled_ < window_rows_) return;
  for (int i = 0; i < shape_.inputs; ++i) {
    const double own = *past(i);
    double& total = totals_[static_cast<std::size_t>(i)];
    total = lambda_ * total + own * own;
  }
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    double* out = factors_[f].row();
    *out++ = 1.0;
    if (conventional())
      *out++ = *past(static_cast<int>(f));
    else
      out = fill_inputs(out);
    for (const LagWindow& residual : residual_windows_)
      out = std::copy_n(residual.window(), lag_count(), out);  // lag last_lag first
    factors_[f].update();
  }
}

void LaggedCorrelation::archive(Archive& a) {
  // not archived: shape_, lambda_, block_columns_, window_rows_ (construction)
  a.within(filled_, 0, window_rows_);
  a(has_origin_, origin_, input_windows_, residual_windows_, factors_, totals_, correlations_,
    defined_);
}

double* LaggedCorrelation::fill_inputs(double* out) const {
  if (shape_.kind == CorrelationKind::kAlternative)
    for (int i = 0; i < shape_.inputs; ++i)
      out = std::copy_n(past(i) + 1, shape_.controlling_lags, out);
  for (int i = 0; i < shape_.inputs; ++i) out = std::copy_n(past(i), block_columns_, out);
  return out;
}

void LaggedCorrelation::evaluate() {
  const int lags = lag_count();
  for (int i = 0; i < shape_.inputs; ++i) {
    const auto s = static_cast<std::size_t>(i);
    LeaveOneOutQr& factors = factors_[conventional() ? s : 0];
    const int block = conventional() ? 0 : i;
    const double* squares = factors.residual_squares(block);
    const double* products = factors.residual_products(block);
    const double own = squares[0];
    defined_[s] = own > calibration::rounding::kOwnMovementSquare * totals_[s] && own > 0.0;
    for (int j = 0; j < shape_.cvs; ++j) {
      auto out = correlations_.col(i * shape_.cvs + j);
      if (!defined_[s]) {
        out.setZero();
        continue;
      }
      const Eigen::Map<const Eigen::ArrayXd> square(squares + 1 + j * lags, lags);
      const Eigen::Map<const Eigen::ArrayXd> product(products + 1 + j * lags, lags);
      // Where a square is 0, so is the product.
      out.array().reverse() = product / (own * square).sqrt().max(kTiny);
    }
  }
}

}  // namespace mpm
