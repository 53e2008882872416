#include "core/mismatch/regression_memory.hpp"

#include <catch2/catch.hpp>

namespace mpm {
namespace {

// As a memory of so many columns is after so many rows of weight 1; the tails are known before.
RegressionMemory with_rows(int columns, int rows, double tails) {
  RegressionMemory memory(columns, {});
  memory.follow_tails(tails);
  memory.rows = rows;
  memory.weight_sum = memory.weight_square = rows;
  return memory;
}

// 5 rows per column, and up to 20 more where the tails are heavy.
TEST_CASE("a memory that has not spoken waits for the rows that its tails ask for") {
  RegressionMemory memory = with_rows(10, 100, 0.3);  // 110
  CHECK_FALSE(memory.ready());
  memory.rows = 110;
  CHECK(memory.ready());
}

TEST_CASE("a verdict does not go again because of one error more") {
  RegressionMemory memory = with_rows(10, 100, 0.2);  // 90
  REQUIRE(memory.ready());
  memory.follow_tails(0.3);
  CHECK(memory.ready());
  memory.follow_tails(1.0);  // 250, and 0.6 of them are 150
  CHECK_FALSE(memory.ready());
  memory.follow_tails(0.3);  // it begins to wait anew
  CHECK_FALSE(memory.ready());
}

TEST_CASE("what spoke by the tails of before is not silenced by the next error") {
  RegressionMemory memory = with_rows(10, 80, 0.2);  // 90
  REQUIRE_FALSE(memory.ready());
  memory.rows = 90;
  REQUIRE(memory.ready());
  memory.follow_tails(0.3);
  CHECK(memory.ready());
}

TEST_CASE("a memory that is cleared has not spoken") {
  RegressionMemory memory = with_rows(10, 100, 0.2);
  memory.follow_tails(0.2);
  REQUIRE(memory.spoke);
  memory.clear();
  CHECK_FALSE(memory.spoke);
}

}  // namespace
}  // namespace mpm
