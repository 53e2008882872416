#pragma once

#include <cstddef>
#include <memory>

#include "core/regression/rotation.hpp"

namespace mpm {

/// Doubles aligned for the kernels, all 0 at first.
struct AlignedDelete {
  void operator()(double* p) const;
};
using AlignedArray = std::unique_ptr<double[], AlignedDelete>;
[[nodiscard]] AlignedArray make_aligned(std::size_t count);

/// Up to `capacity` rows that wait to be taken into a factor together (GivensQr::update_batch), and
/// the space that this needs. Serves factors of any shape with at most `values` columns and
/// responses. No allocation after construction.
class RowBatch {
 public:
  RowBatch(int values, int capacity);

  [[nodiscard]] int capacity() const { return capacity_; }
  /// Where the caller writes row k: regressors, then responses, all finite.
  [[nodiscard]] double* row(int k) { return rows_.get() + offset(k); }
  [[nodiscard]] const double* row(int k) const { return rows_.get() + offset(k); }

 private:
  friend class GivensQr;
  [[nodiscard]] std::size_t offset(int k) const { return static_cast<std::size_t>(k) * stride_; }

  int capacity_;
  std::size_t stride_;
  AlignedArray rows_;
  AlignedArray magnitudes_;              // per row and column, as of that row
  AlignedArray inverse_row_weights_;     // per row
  AlignedArray entries_, gains_, kept_;  // per row, of the columns at hand
};

}  // namespace mpm
