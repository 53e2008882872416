#include "core/mismatch/regression_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"

namespace mpm {

using calibration::gaps::kInterpolated;

RegressionHistory::RegressionHistory(const RegressionShape& shape, int depth)
    : shape_(shape),
      depth_(depth),
      has_origin_(static_cast<std::size_t>(shape.inputs), false),
      origin_(Eigen::VectorXd::Zero(shape.inputs)),
      last_input_(Eigen::VectorXd::Zero(shape.inputs)),
      unknown_(Eigen::VectorXd::Constant(std::max(shape.inputs, shape.cvs),
                                         std::numeric_limits<double>::quiet_NaN())),
      unknown_run_(static_cast<std::size_t>(shape.cvs), 0),
      since_gap_(static_cast<std::size_t>(shape.cvs), 0),
      has_mean_(static_cast<std::size_t>(shape.cvs), false),
      usable_(static_cast<std::size_t>(shape.cvs), false) {
  if (shape.inputs < 1 || shape.cvs < 1 || shape.fir_lags < 1 || shape.residual_order < 1 ||
      shape.tail_poles.empty() || depth < 1)
    throw std::invalid_argument("impossible shape of the regression");
  const int length = depth + std::max(shape.fir_lags, shape.residual_order) + 2;
  for (int i = 0; i < shape.inputs; ++i) {
    input_windows_.emplace_back(length);
    for (std::size_t t = 0; t < shape.tail_poles.size(); ++t) tail_windows_.emplace_back(length);
  }
  for (int j = 0; j < shape.cvs; ++j) {
    residual_windows_.emplace_back(length);
    for (std::size_t t = 0; t < shape.residual_poles.size(); ++t)
      mean_windows_.emplace_back(length);
  }
  for (std::size_t s = 0; s < shape.start_poles.size(); ++s) {
    start_windows_.emplace_back(length);
    start_windows_.back().push(1.0);
  }
}

void RegressionHistory::push(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                             const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  const bool full = filled_ > std::max(shape_.fir_lags, shape_.residual_order);
  for (int j = 0; j < shape_.cvs; ++j) {
    const auto s = static_cast<std::size_t>(j);
    usable_[s] = full && std::isfinite(residuals(j)) && unknown_run_[s] == 0 &&
                 since_gap_[s] >= shape_.residual_order;
    push_residual(j, residuals(j));
  }
  push_inputs(inputs);
  push_starts();
  if (!full) ++filled_;
}

void RegressionHistory::push_residual(int cv, double residual) {
  const auto s = static_cast<std::size_t>(cv);
  LagWindow& window = residual_windows_[s];
  const double held = window.window()[0];
  for (std::size_t t = 0; t < shape_.residual_poles.size(); ++t) {
    LagWindow& mean = mean_windows_[s * shape_.residual_poles.size() + t];
    mean.push(mean.window()[0]);
  }
  if (!std::isfinite(residual)) {
    window.push(held);
    if (++unknown_run_[s] > kInterpolated) since_gap_[s] = 0;
    return;
  }
  const int run = unknown_run_[s];
  window.push(residual);
  const bool bridged = run <= kInterpolated;
  if (bridged)
    for (int back = 1; back <= run; ++back)
      window.set(back, residual + (held - residual) * back / (run + 1));
  follow_means(cv, bridged ? run : 0, !bridged || !has_mean_[s]);
  has_mean_[s] = true;
  unknown_run_[s] = 0;
  ++since_gap_[s];
  if (since_gap_[s] > shape_.residual_order) since_gap_[s] = shape_.residual_order + 1;
}

// Of the samples `from` ago up to now.
void RegressionHistory::follow_means(int cv, int from, bool begin) {
  const double* residual = residual_windows_[static_cast<std::size_t>(cv)].window();
  for (std::size_t t = 0; t < shape_.residual_poles.size(); ++t) {
    LagWindow& mean =
        mean_windows_[static_cast<std::size_t>(cv) * shape_.residual_poles.size() + t];
    const double pole = shape_.residual_poles[t];
    for (int age = from; age >= 0; --age)
      mean.set(age,
               begin ? residual[0] : pole * mean.window()[age + 1] + (1.0 - pole) * residual[age]);
  }
}

void RegressionHistory::push_starts() {
  double largest = 0.0;
  for (std::size_t s = 0; s < start_windows_.size(); ++s)
    largest = std::max(largest, start_windows_[s].window()[0] * shape_.start_poles[s]);
  const bool forgotten = largest < calibration::start::kForgotten;
  for (std::size_t s = 0; s < start_windows_.size(); ++s)
    start_windows_[s].push(forgotten ? 0.0 : start_windows_[s].window()[0] * shape_.start_poles[s]);
  if (forgotten) settled_ = std::min(settled_ + 1, depth_);
}

void RegressionHistory::push_inputs(const Eigen::Ref<const Eigen::VectorXd>& inputs) {
  const std::size_t tails = shape_.tail_poles.size();
  for (int i = 0; i < shape_.inputs; ++i) {
    const auto s = static_cast<std::size_t>(i);
    if (std::isfinite(inputs(i))) {
      if (!has_origin_[s]) origin_(i) = inputs(i);
      has_origin_[s] = true;
      last_input_(i) = inputs(i) - origin_(i);
    }
    const double u = last_input_(i);
    input_windows_[s].push(u);
    for (std::size_t t = 0; t < tails; ++t) {
      LagWindow& window = tail_windows_[s * tails + t];
      const double pole = shape_.tail_poles[t];
      window.push(pole * window.window()[0] + (1.0 - pole) * u);
    }
  }
}

void RegressionHistory::skip(std::int64_t missing) {
  // Beyond all memory a gap changes nothing more.
  for (std::int64_t k = 0; k < std::min(missing, static_cast<std::int64_t>(depth_)); ++k)
    push(unknown_.head(shape_.inputs), unknown_.head(shape_.cvs));
}

void RegressionHistory::archive(Archive& a) {
  // not archived: shape_, depth_, unknown_ (construction)
  a.within(settled_, 0, depth_);
  a(filled_, has_origin_, origin_, last_input_, input_windows_, tail_windows_, residual_windows_,
    mean_windows_, start_windows_, unknown_run_, since_gap_, has_mean_, usable_);
}

void RegressionHistory::fill(int cv, int age, double* row) const {
  fill_lead_in(cv, age, row);
  fill_inputs(age, row + shape_.lead_in());
}

void RegressionHistory::fill_lead_in(int cv, int age, double* row) const {
  *row++ = 1.0;
  for (const LagWindow& residual : residual_windows_)
    row = std::copy_n(residual.window() + age + 1, shape_.residual_order, row);
  const auto first = static_cast<std::size_t>(cv * shape_.means());
  for (std::size_t t = 0; t < shape_.residual_poles.size(); ++t)
    *row++ = mean_windows_[first + t].window()[age + shape_.residual_order + 1];
  for (const LagWindow& start : start_windows_) *row++ = start.window()[age];
}

void RegressionHistory::fill_inputs(int age, double* row) const {
  const std::size_t tails = shape_.tail_poles.size();
  for (std::size_t i = 0; i < input_windows_.size(); ++i) {
    row = std::copy_n(input_windows_[i].window() + age + 1, shape_.fir_lags, row);
    for (std::size_t t = 0; t < tails; ++t)
      *row++ = tail_windows_[i * tails + t].window()[age + shape_.fir_lags + 1];
  }
}

}  // namespace mpm
