#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mpm {

/// The last `length` values of one signal as one contiguous array, newest first. Each value is
/// stored twice, `length` apart, so that no window ever wraps. No allocation after construction.
class LagWindow {
 public:
  explicit LagWindow(int length)
      : length_(static_cast<std::size_t>(length)), values_(2 * length_, 0.0) {}

  void push(double value) {
    position_ = (position_ == 0 ? length_ : position_) - 1;
    values_[position_] = value;
    values_[position_ + length_] = value;
  }
  /// Replaces the value `lag` samples ago.
  void set(int lag, double value) {
    const std::size_t at = position_ + static_cast<std::size_t>(lag);
    values_[at] = value;
    values_[at < length_ ? at + length_ : at - length_] = value;
  }
  /// window()[l] is the value l samples ago, 0 <= l < length.
  [[nodiscard]] const double* window() const { return values_.data() + position_; }

  /// The window alone: where it lies in its ring makes no difference.
  template <class Archive>
  void archive(Archive& a) {
    a.length(length_);
    if (a.reads()) position_ = 0;
    a.doubles(values_.data() + position_, length_);
    if (a.reads()) std::copy_n(values_.begin(), length_, values_.begin() + length());
  }

 private:
  [[nodiscard]] std::ptrdiff_t length() const { return static_cast<std::ptrdiff_t>(length_); }

  std::size_t length_;
  std::size_t position_ = 0;
  std::vector<double> values_;
};

}  // namespace mpm
