#include "core/mismatch/older_movement.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/core/counter_noise.hpp"

namespace mpm::older_movement_test {
namespace {

const RegressionShape kShape{2, 1, 2, 1, {0.5}};
constexpr int kDepth = 300;

/// The samples at which it is told, of `samples`, the first input `scale(k)` times as large.
template <class Scale>
std::vector<int> told(int samples, double lambda, const Scale& scale) {
  RegressionHistory history(kShape, kDepth);
  OlderMovement older(kShape, lambda, kDepth);
  Eigen::VectorXd u(2), e(1);
  std::vector<int> at;
  for (int k = 0; k < samples; ++k) {
    u << scale(k) * test::coloured(1, k), test::coloured(2, k) + 1e4;
    e(0) = test::uniform(3, k);
    history.push(u, e);
    if (older.outweighs(history)) at.push_back(k);
  }
  return at;
}

// Rows 100 to 199 a thousand times larger would outweigh all others for 14 memories of 100 rows
// (1e6 = exp(13.8)). They are told within two memories after the last of them, and not again.
TEST_CASE("what moved as it never does is told within two memories") {
  const std::vector<int> at =
      told(3000, 0.99, [](int k) { return k >= 100 && k < 200 ? 1000.0 : 1.0; });
  REQUIRE_FALSE(at.empty());
  CHECK(at.back() >= 200 + 175);
  CHECK(at.back() <= 200 + 200);
  CHECK(at.size() <= 4);  // while they become older, look by look
}

TEST_CASE("an input that moves as ever, more than before or comes to rest outweighs nothing") {
  CHECK(told(5000, 0.99, [](int) { return 1.0; }).empty());
  CHECK(told(5000, 0.99, [](int k) { return k < 2000 ? 1.0 : 100.0; }).empty());
  CHECK(told(5000, 0.99, [](int k) { return k < 2000 ? 1.0 : 0.0; }).empty());
  CHECK(told(5000, 1.0, [](int k) { return k < 200 ? 1000.0 : 1.0; }).empty());
}

}  // namespace
}  // namespace mpm::older_movement_test
