#include "sim/signals/test_signals.hpp"

#include <catch2/catch.hpp>

namespace mpm::sim {
namespace {

TEST_CASE("a test moves its MV between two levels, and nothing before or after") {
  config::TestSignal steps;
  steps.mv = "u2";
  steps.size = 2.0;
  steps.hold_s = 30.0;
  steps.random = false;
  steps.from_s = 100.0;
  steps.until_s = 220.0;
  config::TestSignal random = steps;
  random.mv = "u1";
  random.random = true;
  random.hold_s = 10.0;
  const Eigen::Vector3d origin(5.0, 10.0, 20.0);
  TestSignals tests({steps, random}, {"u1", "u2", "u3"}, origin, 10.0, 1);
  int up = 0;
  for (std::int64_t k = 0; k < 30; ++k) {
    const bool lasts = tests.advance(k);
    CHECK(lasts == (k >= 10 && k < 22));
    const Eigen::VectorXd& now = tests.values();
    CHECK(now(2) == 20.0);
    if (!lasts) {
      CHECK(now == origin);
      continue;
    }
    CHECK(now(1) == ((k - 10) / 3 % 2 == 0 ? 12.0 : 8.0));
    CHECK((now(0) == 3.0 || now(0) == 7.0));
    up += now(0) == 7.0 ? 1 : 0;
  }
  CHECK(up > 0);
  CHECK(up < 12);
}

}  // namespace
}  // namespace mpm::sim
