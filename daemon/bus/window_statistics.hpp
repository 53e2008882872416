#pragma once

#include <cstddef>
#include <deque>

namespace mpm::bus {

/// Mean, extremes and spread of the last values.
class WindowStatistics {
 public:
  /// `window` >= 1: how many values count.
  explicit WindowStatistics(std::size_t window) : window_(window) {}

  void add(double value);

  [[nodiscard]] std::size_t count() const { return values_.size(); }
  // Of an empty window: 0.
  [[nodiscard]] double mean() const;
  [[nodiscard]] double min() const;
  [[nodiscard]] double max() const;
  [[nodiscard]] double deviation() const;  ///< divided by n, not n - 1

 private:
  std::size_t window_;
  std::deque<double> values_;
};

}  // namespace mpm::bus
