#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace mpm {

/// Mean and spread of a signal, from sums that lose no digits to its level (Welford 1962) and that
/// add up (Chan, Golub and LeVeque 1979).
class Moments {
 public:
  void take(double value) {
    ++count_;
    const double off = value - mean_;
    mean_ += off / static_cast<double>(count_);
    squares_ += off * (value - mean_);
  }
  void add(const Moments& other) {
    if (other.count_ == 0) return;
    const auto here = static_cast<double>(count_), there = static_cast<double>(other.count_);
    const double off = other.mean_ - mean_, all = here + there;
    mean_ += off * (there / all);
    squares_ += other.squares_ + off * off * (here * there / all);
    count_ += other.count_;
  }

  [[nodiscard]] std::int64_t count() const { return count_; }
  /// NaN of no value, as the rms; the variance (about the mean, n - 1) of fewer than two.
  [[nodiscard]] double mean() const { return count_ > 0 ? mean_ : kUnknown; }
  [[nodiscard]] double variance() const {
    return count_ > 1 ? squares_ / static_cast<double>(count_ - 1) : kUnknown;
  }
  [[nodiscard]] double rms() const {
    return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_) + mean_ * mean_)
                      : kUnknown;
  }

  template <class Archive>
  void archive(Archive& a) {
    a(count_, mean_, squares_);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  // about the mean
};

}  // namespace mpm
