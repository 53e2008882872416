#pragma once

#include "core/mismatch/calibration.hpp"
#include "core/regression/givens_qr.hpp"

namespace mpm {

/// How long a memory is: rows fade with `lambda` per row, or, where `window` > 0, the last `window`
/// samples count alike and older ones not at all.
struct MemoryLength {
  double lambda = 1.0;  ///< 0 < lambda <= 1; 1 in a sliding window
  int window = 0;       ///< samples
};

/// One CV's regression over one memory: the factor of its weighted rows and the sums of their
/// forgetting weights.
struct RegressionMemory {
  RegressionMemory(int columns, const MemoryLength& memory_length)
      : length(memory_length), factor(columns, 1) {}

  MemoryLength length;
  GivensQr factor;
  double weight_sum = 0.0;     ///< W1 = sum lambda^age
  double weight_square = 0.0;  ///< W2 = sum lambda^(2 age)
  int rows = 0;
  double heavy_tails = 0.0;  ///< 0..1, asks for more rows
  bool spoke = false;        ///< since it was cleared: a few errors more do not silence it again

  /// Takes the first `count` rows of a batch, oldest first; consumes them.
  void take(RowBatch& batch, int count) {
    const double lambda = length.lambda;
    factor.update_batch(batch, count, lambda);
    for (int k = 0; k < count; ++k) {
      weight_sum = lambda * weight_sum + 1.0;
      weight_square = lambda * lambda * weight_square + 1.0;
    }
    rows += count;
  }
  void clear() {
    factor.clear();
    weight_sum = weight_square = 0.0;
    rows = 0;
    spoke = false;
  }
  template <class Archive>
  void archive(Archive& a) {
    // not archived: length (construction)
    a(factor, weight_sum, weight_square, rows, heavy_tails, spoke);
  }
  /// W1^2 / W2: rows that equal weights would need for the same precision.
  [[nodiscard]] double effective_rows() const {
    return weight_square > 0.0 ? weight_sum * weight_sum / weight_square : 0.0;
  }
  [[nodiscard]] double freedom() const { return effective_rows() - factor.columns(); }
  /// Takes what errors now say of the tails, 0..1. Asked before as well: it may have spoken by what
  /// they said until now.
  void follow_tails(double heavy) {
    spoke = ready();
    heavy_tails = heavy;
    spoke = ready();
  }
  /// Rows that it takes to speak, or to go on speaking.
  [[nodiscard]] double needed_rows() const {
    const double needed = (calibration::rows_needed::kPerColumn +
                           calibration::rows_needed::kMorePerColumn * heavy_tails) *
                          factor.columns();
    return spoke ? calibration::rows_needed::kKept * needed : needed;
  }
  [[nodiscard]] bool ready() const { return rows >= needed_rows() && ready_but_for_tails(); }
  /// Enough rows were the noise normal.
  [[nodiscard]] bool ready_but_for_tails() const {
    return rows >= calibration::rows_needed::kPerColumn * factor.columns() &&
           freedom() >= factor.columns();
  }
};

}  // namespace mpm
