#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mpm {

/// Past inputs (deviations after the static blocks), and what single channels make of them, one row
/// each. Every value is stored twice so that any window of the
/// last `capacity` values lies in one piece.
class InputHistory {
 public:
  InputHistory(int inputs, int capacity)
      : capacity_(capacity), values_(static_cast<std::size_t>(2 * inputs * capacity), 0.0) {}

  void fill(int input, double value) {
    const auto first = values_.begin() + 2 * input * capacity_;
    std::fill(first, first + 2 * capacity_, value);
  }
  void next() { newest_ = newest_ + 1 == capacity_ ? 0 : newest_ + 1; }
  void set_newest(int input, double value) {
    double* row = values_.data() + 2 * input * capacity_;
    row[newest_] = value;
    row[newest_ + capacity_] = value;
  }
  /// Points to the newest value; element -l is l samples older, l < capacity.
  [[nodiscard]] const double* newest(int input) const {
    return values_.data() + 2 * input * capacity_ + newest_ + capacity_;
  }

  /// Where the rows lie in their ring makes no difference: they are as if the newest came first.
  template <class Archive>
  void archive(Archive& a) {
    a.length(values_.size());
    const auto capacity = static_cast<std::size_t>(capacity_);
    for (std::size_t row = 0; row < values_.size(); row += 2 * capacity) {
      double* oldest = values_.data() + row + (a.reads() ? 1 : newest_ + 1);
      a.doubles(oldest, capacity);
      if (!a.reads()) continue;
      values_[row] = oldest[capacity - 1];
      std::copy_n(oldest, capacity - 1, oldest + capacity);
    }
    if (a.reads()) newest_ = 0;
  }

 private:
  int capacity_;
  int newest_ = 0;
  std::vector<double> values_;
};

}  // namespace mpm
