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
  double weight_sum = 0.0;     ///< W1 = sum lambda^age share
  double weight_square = 0.0;  ///< W2 = sum (lambda^age share)^2
  int rows = 0;

  /// Takes the first `count` rows of a batch, oldest first, of which each counts for its share of a
  /// row (`RowWeight`); consumes them.
  void take(RowBatch& batch, const double* shares, int count) {
    const double lambda = length.lambda;
    factor.update_batch(batch, count, lambda);
    for (int k = 0; k < count; ++k) {
      weight_sum = lambda * weight_sum + shares[k];
      weight_square = lambda * lambda * weight_square + shares[k] * shares[k];
    }
    rows += count;
  }
  void clear() {
    factor.clear();
    weight_sum = weight_square = 0.0;
    rows = 0;
  }
  template <class Archive>
  void archive(Archive& a) {
    // not archived: length (construction)
    a(factor, weight_sum, weight_square, rows);
  }
  /// W1^2 / W2: rows that equal weights would need for the same precision.
  [[nodiscard]] double effective_rows() const {
    return weight_square > 0.0 ? weight_sum * weight_sum / weight_square : 0.0;
  }
  [[nodiscard]] double freedom() const { return effective_rows() - factor.columns(); }
  /// Rows that it takes to say anything.
  [[nodiscard]] double needed_rows() const {
    return calibration::rows_needed::kPerColumn * factor.columns();
  }
  [[nodiscard]] bool ready() const {
    return rows >= needed_rows() && freedom() >= factor.columns();
  }
};

}  // namespace mpm
