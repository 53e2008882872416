#include "core/nonlinear/rank_window.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

RankWindow::RankWindow(int signals, int length)
    : signals_(signals),
      length_(static_cast<std::size_t>(length)),
      factor_(std::max(signals - 1, 1), 2),
      feed_(std::max(signals, 2) + 1) {
  if (signals < 2 || length < 3) throw std::invalid_argument("impossible window of ranks");
  values_.resize(length_ * static_cast<std::size_t>(signals));
  doubled_.resize(values_.size());
}

void RankWindow::push(const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (int s = 0; s < signals_; ++s) replace(s, next_, values(s));
  count_ = std::min(count_ + 1, static_cast<int>(length_));
  next_ = (next_ + 1) % length_;
}

// In the first `count_` slots stands what the window has, in any order. What leaves no longer
// counts below the others, what comes does.
void RankWindow::replace(int signal, std::size_t slot, double value) {
  double* values = values_.data() + first(signal);
  std::int32_t* doubled = doubled_.data() + first(signal);
  const auto count = static_cast<std::size_t>(count_);
  if (count == length_) {
    const double gone = values[slot];
    for (std::size_t l = 0; l < count; ++l)
      doubled[l] -= 2 * static_cast<std::int32_t>(gone < values[l]) +
                    static_cast<std::int32_t>(gone == values[l]);
  }
  values[slot] = value;
  std::int32_t own = 0;
  const std::size_t filled = std::max(count, slot + 1);
  for (std::size_t l = 0; l < filled; ++l) {
    const auto above = static_cast<std::int32_t>(value < values[l]);
    const auto same = static_cast<std::int32_t>(value == values[l]);
    const auto below = static_cast<std::int32_t>(value > values[l]);
    doubled[l] += 2 * above + same;
    own += 2 * below + same;
  }
  doubled[slot] = own + 1;
}

void RankWindow::archive(Archive& a) {
  // not archived: signals_, length_ (construction)
  // not archived: factor_, feed_ (empty between calls)
  a.within(count_, 0, static_cast<int>(length_));
  a.within(next_, 0, length_ - 1);
  a(values_, doubled_);
}

double RankWindow::rank(int signal, int age) const {
  const std::size_t slot = (next_ + length_ - 1 - static_cast<std::size_t>(age)) % length_;
  return 0.5 * doubled_[first(signal) + slot];
}

double RankWindow::coefficient(int a, int b) const {
  const std::int32_t* x = doubled_.data() + first(a);
  const std::int32_t* y = doubled_.data() + first(b);
  const std::int64_t mean = count_ + 1;
  std::int64_t product = 0, x_square = 0, y_square = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(count_); ++l) {
    product += (x[l] - mean) * (y[l] - mean);
    x_square += (x[l] - mean) * (x[l] - mean);
    y_square += (y[l] - mean) * (y[l] - mean);
  }
  if (x_square == 0 || y_square == 0) return 0.0;
  return static_cast<double>(product) /
         (std::sqrt(static_cast<double>(x_square)) * std::sqrt(static_cast<double>(y_square)));
}

double RankWindow::partial_coefficient() {
  factor_.clear();
  const double mean = count_ + 1;
  for (std::size_t l = 0; l < static_cast<std::size_t>(count_); ++l) {
    double* row = feed_.next_row(factor_);
    const auto centred = [&](int signal) { return doubled_[first(signal) + l] - mean; };
    *row++ = 1.0;
    for (int s = 2; s < signals_; ++s) *row++ = centred(s);
    *row++ = centred(0);
    *row = centred(1);
  }
  feed_.flush(factor_);
  const double squares = factor_.residual_square(0) * factor_.residual_square(1);
  return squares > 0.0 ? std::clamp(factor_.residual_product(1) / std::sqrt(squares), -1.0, 1.0)
                       : 0.0;
}

double RankWindow::p_value(double partial_coefficient) const {
  const double freedom = count_ - signals_;
  const double square = partial_coefficient * partial_coefficient;
  if (!(freedom > 0.0)) return 1.0;
  return square < 1.0 ? f_upper_tail(square * freedom / (1.0 - square), 1.0, freedom) : 0.0;
}

}  // namespace mpm
