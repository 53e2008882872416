#pragma once

#include "core/regression/givens_qr.hpp"

namespace mpm {

/// Gives rows to a factor, some at a time: that is faster, and says the same. No allocation after
/// construction.
class RowFeed {
 public:
  /// `values`: columns and responses of the widest factor.
  explicit RowFeed(int values) : rows_(values, kTogether) {}

  /// Where the caller writes the next row of `factor`. Rows before it are weighted by `lambda` for
  /// each one after them.
  [[nodiscard]] double* next_row(GivensQr& factor, double lambda = 1.0) {
    if (waiting_ == kTogether) flush(factor, lambda);
    return rows_.row(waiting_++);
  }
  /// Gives the factor all that wait. Before it is read, and before another one is fed.
  void flush(GivensQr& factor, double lambda = 1.0) {
    if (waiting_ > 0) factor.update_batch(rows_, waiting_, lambda);
    waiting_ = 0;
  }

 private:
  static constexpr int kTogether = 32;

  RowBatch rows_;
  int waiting_ = 0;
};

}  // namespace mpm
