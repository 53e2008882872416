#include "core/mismatch/lagged_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mpm {
namespace {

// An input whose own movement (residual sum of squares given the others) is below this fraction of
// its total carries rounding noise only: relative s.d. 1e-9, well above eps and well below any
// collinearity that double precision can still resolve.
constexpr double kOwnMovement = 1e-18;

}  // namespace

LaggedCorrelation::LaggedCorrelation(const Shape& shape, double lambda)
    : shape_(shape),
      lambda_(lambda),
      window_rows_(std::max(shape.last_lag + shape.controlling_lags, 0) + 1),
      origin_(Eigen::VectorXd::Zero(shape.inputs)),
      correlations_(
          Eigen::MatrixXd::Zero(shape.last_lag - shape.first_lag + 1, shape.inputs * shape.cvs)),
      defined_(static_cast<std::size_t>(shape.inputs), false) {
  if (shape.inputs < 1 || shape.cvs < 1 || shape.controlling_lags < 0 || shape.last_lag < 0 ||
      shape.first_lag > shape.last_lag || shape.first_lag < -shape.controlling_lags ||
      !(lambda > 0.0 && lambda <= 1.0))
    throw std::invalid_argument("impossible shape of the lagged correlation");
  const int controls = (shape.inputs - 1) * (shape.controlling_lags + 1) + 1;
  for (int i = 0; i < shape.inputs; ++i) {
    input_windows_.emplace_back(window_rows_);
    factors_.emplace_back(controls, 1 + shape.cvs * lag_count());
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
    fill_row(i);
    GivensQr& factor = factors_[static_cast<std::size_t>(i)];
    double& total = totals_[static_cast<std::size_t>(i)];
    const double own = factor.row()[factor.columns()];
    total = lambda_ * total + own * own;
    factor.update(lambda_);
  }
}

void LaggedCorrelation::fill_row(int input) {
  GivensQr& factor = factors_[static_cast<std::size_t>(input)];
  double* out = factor.row();
  *out++ = 1.0;
  for (int i = 0; i < shape_.inputs; ++i) {
    if (i == input) continue;
    const double* at_t = input_windows_[static_cast<std::size_t>(i)].window() + shape_.last_lag;
    out = std::copy_n(at_t, shape_.controlling_lags + 1, out);
  }
  *out++ = input_windows_[static_cast<std::size_t>(input)].window()[shape_.last_lag];
  for (const LagWindow& residual : residual_windows_)
    out = std::copy_n(residual.window(), lag_count(), out);  // lag last_lag first
}

void LaggedCorrelation::evaluate() {
  const int lags = lag_count();
  for (int i = 0; i < shape_.inputs; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const GivensQr& factor = factors_[s];
    const double* squares = factor.residual_squares();
    const double* products = factor.residual_products();
    const double own = squares[0];
    defined_[s] = own > kOwnMovement * totals_[s] && own > 0.0;
    for (int j = 0; j < shape_.cvs; ++j) {
      double* out = correlations_.col(i * shape_.cvs + j).data();
      for (int l = 0; l < lags; ++l) {
        const int response = 1 + j * lags + (lags - 1 - l);
        const double scale = std::sqrt(own * squares[response]);
        out[l] = defined_[s] && scale > 0.0 ? products[response] / scale : 0.0;
      }
    }
  }
}

}  // namespace mpm
