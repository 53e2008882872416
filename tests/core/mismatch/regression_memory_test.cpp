#include "core/mismatch/regression_memory.hpp"

#include <catch2/catch.hpp>

namespace mpm {
namespace {

RegressionMemory with_rows(int columns, int count, double share, double lambda = 1.0) {
  RegressionMemory memory(columns, {lambda, 0});
  RowBatch batch(columns + 1, 1);
  for (int k = 0; k < count; ++k) {
    for (int c = 0; c <= columns; ++c) batch.row(0)[c] = (k + c) % (c + 2);
    memory.take(batch, &share, 1);
  }
  return memory;
}

// 5 rows per column, and as many degrees of freedom as columns.
TEST_CASE("a memory speaks once it has rows enough") {
  CHECK_FALSE(with_rows(4, 19, 1.0).ready());
  CHECK(with_rows(4, 20, 1.0).ready());
  CHECK_FALSE(with_rows(4, 20, 1.0, 0.5).ready());  // 3 effective rows
}

// W1^2 / W2 of equal shares, however large; of forgetting (1 + lambda) / (1 - lambda).
TEST_CASE("effective rows are those that count") {
  CHECK(with_rows(4, 30, 0.25).effective_rows() == Approx(30.0));
  CHECK(with_rows(4, 30, 0.25).weight_sum == Approx(7.5));
  CHECK(with_rows(4, 2000, 1.0, 0.95).effective_rows() == Approx(39.0));
  RegressionMemory memory = with_rows(4, 30, 1.0);
  const double little = 0.02;
  RowBatch batch(5, 1);
  for (int c = 0; c < 5; ++c) batch.row(0)[c] = c;
  memory.take(batch, &little, 1);
  CHECK(memory.rows == 31);
  CHECK(memory.effective_rows() == Approx(30.02 * 30.02 / 30.0004));
}

}  // namespace
}  // namespace mpm
