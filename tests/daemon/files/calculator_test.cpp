#include "daemon/files/calculator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "config/load_unit.hpp"
#include "tests/allocation_counter.hpp"

namespace mpm::files::calculator_test {
namespace {

config::UnitConfig unit() {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: u\nsample_time: 10\nsignals:\n"
      "  mv: [valve]\n  dv: [d]\n  cv: [{tag: heat, setpoint: goal}, y]\n  raw: [flow, T]\n"
      "  calc:\n    heat: flow * rise\n    rise: T - 20\n    goal: heat + 1\n    d: 1 / valve\n",
      "u.yaml", config::ModelNeed::kMayBeMissing);
  REQUIRE(loaded.ok());
  return loaded.config;
}

struct Bench {
  config::UnitConfig config = unit();
  Calculator calculator{config};
  Frame frame{config.counts()};

  void put(SignalKind kind, int index, double value, Quality quality = Quality::kGood) {
    frame[kind].values(index) = value;
    frame[kind].quality[static_cast<std::size_t>(index)] = quality;
  }
  [[nodiscard]] double value(SignalKind kind, int index = 0) const {
    return frame[kind].values(index);
  }
  [[nodiscard]] Quality quality(SignalKind kind, int index = 0) const {
    return frame[kind].quality[static_cast<std::size_t>(index)];
  }
};

TEST_CASE("calculated signals get their values, and only they") {
  Bench bench;
  bench.put(SignalKind::kMv, 0, 4.0);
  bench.put(SignalKind::kRaw, 0, 2.0);
  bench.put(SignalKind::kRaw, 1, 50.0);
  bench.put(SignalKind::kCv, 0, 7.0);  // somebody published one
  bench.put(SignalKind::kCv, 1, 3.0, Quality::kUncertain);
  bench.calculator.fill(bench.frame);
  CHECK(bench.value(SignalKind::kCv, 0) == 60.0);
  CHECK(bench.quality(SignalKind::kCv, 0) == Quality::kGood);
  CHECK(bench.value(SignalKind::kSetpoint) == 61.0);
  CHECK(bench.value(SignalKind::kDv) == 0.25);
  CHECK(bench.value(SignalKind::kCv, 1) == 3.0);
  CHECK(bench.quality(SignalKind::kCv, 1) == Quality::kUncertain);
  CHECK(bench.value(SignalKind::kMv) == 4.0);
}

TEST_CASE("a calculated value is as good as the worst of its inputs") {
  Bench bench;
  bench.put(SignalKind::kMv, 0, 4.0);
  bench.put(SignalKind::kRaw, 0, 2.0);
  bench.put(SignalKind::kRaw, 1, 50.0, Quality::kUncertain);
  bench.calculator.fill(bench.frame);
  CHECK(bench.quality(SignalKind::kCv) == Quality::kUncertain);
  CHECK(bench.value(SignalKind::kCv) == 60.0);
  CHECK(bench.quality(SignalKind::kDv) == Quality::kGood);  // does not depend on it

  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto [value, quality] =
      GENERATE_COPY(table<double, Quality>({{50.0, Quality::kBad}, {nan, Quality::kGood}}));
  bench.put(SignalKind::kRaw, 1, value, quality);
  bench.calculator.fill(bench.frame);
  CHECK(bench.quality(SignalKind::kCv) == Quality::kBad);
  CHECK(std::isnan(bench.value(SignalKind::kCv)));
  CHECK(bench.quality(SignalKind::kSetpoint) == Quality::kBad);  // by way of heat
  CHECK(bench.quality(SignalKind::kDv) == Quality::kGood);

  bench.put(SignalKind::kRaw, 1, 50.0);  // and back
  bench.calculator.fill(bench.frame);
  CHECK(bench.value(SignalKind::kCv) == 60.0);
}

TEST_CASE("a result that is not finite is bad") {
  Bench bench;
  bench.put(SignalKind::kMv, 0, 0.0);
  bench.calculator.fill(bench.frame);
  CHECK(bench.quality(SignalKind::kDv) == Quality::kBad);
  CHECK(std::isnan(bench.value(SignalKind::kDv)));
}

TEST_CASE("filling a frame allocates nothing") {
  Bench bench;
  bench.put(SignalKind::kMv, 0, 4.0);
  bench.put(SignalKind::kRaw, 0, 2.0);
  bench.put(SignalKind::kRaw, 1, 50.0);
  bench.calculator.fill(bench.frame);
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 100; ++i) bench.calculator.fill(bench.frame);
  CHECK(test::allocation_count() == before);
}

}  // namespace
}  // namespace mpm::files::calculator_test
