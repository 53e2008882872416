#include "core/nonlinear/rank_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/archive/archive.hpp"
#include "core/nonlinear/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

RankWindow::RankWindow(int signals, int length)
    : signals_(signals),
      length_(static_cast<std::size_t>(length)),
      factor_(std::max(signals, 2), std::max(signals, 2)) {
  if (signals < 2 || length < 3) throw std::invalid_argument("impossible window of ranks");
  values_.resize(length_ * static_cast<std::size_t>(signals));
  doubled_.resize(values_.size());
  order_.reserve(static_cast<std::size_t>(signals));
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
  const bool full = static_cast<std::size_t>(count_) == length_;
  const double gone = full ? values[slot] : std::numeric_limits<double>::infinity();
  values[slot] = value;
  std::int32_t own = 0;
  const std::size_t filled = full ? length_ : slot + 1;
  for (std::size_t l = 0; l < filled; ++l) {
    const double each = values[l];
    const auto above = static_cast<std::int32_t>(value < each);
    const auto same = static_cast<std::int32_t>(value == each);
    doubled[l] += 2 * above + same - 2 * static_cast<std::int32_t>(gone < each) -
                  static_cast<std::int32_t>(gone == each);
    own += 2 * above + same;
  }
  // Those above it and itself are known, the others are below.
  doubled[slot] = 2 * static_cast<std::int32_t>(filled) - own + 1;
}

void RankWindow::archive(Archive& a) {
  // not archived: signals_, length_ (construction)
  // not archived: factor_, order_ (empty between calls)
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

// The two signals come last in the factor L of the coefficients: what is left of them is L(a, a)
// and (L(b, a), L(b, b)).
double RankWindow::partial_coefficient(int a, int b, std::span<const int> held) {
  order_.assign(held.begin(), held.end());
  order_.push_back(a);
  order_.push_back(b);
  const auto count = static_cast<Eigen::Index>(order_.size());
  for (Eigen::Index row = 0; row < count; ++row) {
    for (Eigen::Index column = 0; column <= row; ++column) {
      const int first = order_[static_cast<std::size_t>(row)];
      const int second = order_[static_cast<std::size_t>(column)];
      double left = first == second ? 1.0 : coefficient(first, second);
      for (Eigen::Index l = 0; l < column; ++l) left -= factor_(row, l) * factor_(column, l);
      const double pivot = column < row ? factor_(column, column) : 1.0;
      if (column == row)
        left = left > calibration::nonlinear_rounding::kLeftOfRanks ? std::sqrt(left) : 0.0;
      factor_(row, column) = pivot > 0.0 ? left / pivot : 0.0;
    }
  }
  const double product = factor_(count - 1, count - 2);
  const double square = std::hypot(product, factor_(count - 1, count - 1));
  return square > 0.0 ? std::clamp(product / square, -1.0, 1.0) : 0.0;
}

double RankWindow::p_value(double partial_coefficient, int held) const {
  const double freedom = count_ - held - 2;
  const double square = partial_coefficient * partial_coefficient;
  if (!(freedom > 0.0)) return 1.0;
  return square < 1.0 ? f_upper_tail(square * freedom / (1.0 - square), 1.0, freedom) : 0.0;
}

}  // namespace mpm
