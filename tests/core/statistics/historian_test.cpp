#include "core/statistics/historian.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::historian_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 2000;
constexpr std::uint64_t kSeeds = 50;

/// A CV of s.d. about 1: what a lag makes of white noise, and a little noise of the sensor's.
VectorXd signal(std::uint64_t seed) {
  return 0.31 * test::autoregressive(test::normal(seed, kRows), 0.95) +
         0.05 * test::normal(seed + 1000, kRows);
}

/// Archived where it is off the last archived value by the deadband.
VectorXd by_exception(VectorXd values, double deadband) {
  for (Index k = 1; k < values.size(); ++k)
    if (std::abs(values(k) - values(k - 1)) < deadband) values(k) = values(k - 1);
  return values;
}

/// Straight lines between every 7th to 12th row.
VectorXd interpolated(VectorXd values, std::uint64_t seed) {
  for (Index k = 0, next = 0; k + 13 < values.size(); k = next) {
    next = k + 9 + static_cast<Index>(2.9 * test::uniform(seed, k));
    const double slope = (values(next) - values(k)) / static_cast<double>(next - k);
    for (Index i = k + 1; i < next; ++i) values(i) = values(k) + slope * static_cast<double>(i - k);
  }
  return values;
}

VectorXd rounded(const VectorXd& values, double quantum) {
  return quantum * (values / quantum).array().round();
}

// The smallest of some hundred moves is the deadband and a little of what goes beyond it.
TEST_CASE("a planted deadband is found") {
  for (const double deadband : {0.3, 0.6, 1.0}) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const HistorianTraits traits = historian_traits(by_exception(signal(seed), deadband));
      CHECK_FALSE(traits.interpolated);
      CHECK(traits.quantum == 0.0);
      if (traits.deadband >= deadband && traits.deadband < 1.05 * deadband) ++found;
    }
    CHECK(found == kSeeds);
  }
  CHECK(beyond_use(historian_traits(by_exception(signal(1), 1.0))));
  CHECK_FALSE(beyond_use(historian_traits(by_exception(signal(1), 0.3))));
}

TEST_CASE("straight lines between archived points are found") {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const HistorianTraits traits = historian_traits(interpolated(signal(seed), seed));
    CHECK(traits.interpolated);
    CHECK(traits.compressed());
    CHECK(traits.deadband == 0.0);
  }
}

TEST_CASE("a converter coarser than what it measures moves by is found") {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const HistorianTraits traits = historian_traits(rounded(signal(seed), 0.5));
    CHECK(traits.quantum == Approx(0.5).epsilon(1e-6));
    CHECK_FALSE(traits.compressed());
  }
}

TEST_CASE("what is read every so many rows is told, whether it stands between or is not known") {
  for (const Index every : {2, 3, 7, 16}) {
    CAPTURE(every);
    const VectorXd value = rounded(signal(1), 0.001);
    VectorXd stands(kRows), blank(kRows);
    for (Index k = 0; k < kRows; ++k) {
      stands(k) = value(k - k % every);
      blank(k) = k % every == 0 ? value(k) : std::nan("");
    }
    CHECK(reading_interval(stands) == every);
    CHECK(reading_interval(blank) == every);
  }
  // A cycle of 10.3 rows.
  CHECK(reading_interval(VectorXd::NullaryExpr(kRows, [](Index k) {
          return test::uniform(3, static_cast<Index>(static_cast<double>(k) / 10.3));
        })) == 10);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    CHECK(reading_interval(signal(seed)) == 0);
    for (const double size : {0.01, 0.1, 0.3, 1.0}) {
      CHECK(reading_interval(rounded(signal(seed), size)) == 0);
      CHECK(reading_interval(by_exception(signal(seed), size)) == 0);
    }
  }
}

TEST_CASE("what rests or bends by nature is not accused") {
  int accused = 0;
  const auto look = [&](const VectorXd& values) {
    const HistorianTraits traits = historian_traits(values);
    accused += traits.compressed() || traits.quantum > 0.0 || beyond_use(traits) ? 1 : 0;
  };
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    look(signal(seed));
    look(test::normal(seed, kRows));
    look(rounded(signal(seed), 0.01));  // three digits
    look(test::telegraph(seed, kRows, 12));
    look(test::telegraph(seed, kRows, 12) + 0.5 * test::telegraph(seed + 50, kRows, 17));
    // Moved every 20 rows to anywhere, and by a controller of a slower cycle.
    const VectorXd anywhere = test::normal(seed + 200, kRows);
    const VectorXd slow = signal(seed);
    look(VectorXd::NullaryExpr(kRows, [&](Index k) { return anywhere(k / 20); }));
    look(VectorXd::NullaryExpr(kRows, [&](Index k) { return slow(k - k % 5); }));
    // Slow and smooth: a fifth to twenty periods in all.
    for (const double periods : {0.2, 1.0, 20.0})
      look(VectorXd::NullaryExpr(kRows, [&](Index k) {
        return std::sin(2.0 * M_PI * periods * static_cast<double>(k) / kRows +
                        static_cast<double>(seed));
      }));
  }
  CHECK(accused == 0);  // of 500
}

TEST_CASE("a cycle of readings begins where they come, late by a row or not") {
  const VectorXd values = signal(3);
  const auto read = [&](Index every, Index offset, bool late) {
    VectorXd held = values;
    for (Index k = 0, last = 0, reading = 0; k < kRows; ++k) {
      // Every third reading comes a row late.
      const bool now = k >= offset && (k - offset) % every == (late && reading % 3 == 2 ? 1 : 0);
      if (now) last = k, ++reading;
      held(k) = values(last);
    }
    return held;
  };
  CHECK(reading_offset(read(5, 3, false), 5) == 3.0);
  CHECK(reading_offset(read(12, 0, false), 12) == 0.0);
  CHECK(reading_offset(read(12, 7, true), 12) == 8.0);
  CHECK(reading_offset(read(12, 11, true), 12) == 0.0);
  CHECK(reading_cycle(read(5, 3, false)) == 5.0);
  CHECK(reading_cycle(read(12, 7, false)) == 12.0);
  CHECK_FALSE(reading_offset(read(7, 3, false), 5));
  CHECK_FALSE(reading_offset(values, 5));
  CHECK_FALSE(reading_offset(VectorXd::Ones(kRows), 5));
}

TEST_CASE("a cycle that is no whole number of rows is found, with each of its readings") {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VectorXd values = signal(seed);
    for (const double every : {2.5, 4.97, 5.03, 7.3, 10.3, 24.6, 59.9}) {
      // The n-th reading is taken at 1.7 + n every, and is in the rows from the next one on.
      CAPTURE(seed, every);
      const auto row_of = [&](Index n) {
        return static_cast<Index>(std::ceil(1.7 + static_cast<double>(n) * every));
      };
      VectorXd held = values;
      for (Index n = 0; row_of(n) < kRows; ++n)
        for (Index k = row_of(n); k < std::min<Index>(kRows, row_of(n + 1)); ++k)
          held(k) = values(row_of(n));
      const double cycle = reading_cycle(held);
      CHECK(std::abs(cycle - every) * kRows / every < 0.5);  // rows, at the end
      const auto offset = reading_offset(held, cycle);
      REQUIRE(offset);
      const Index skipped = static_cast<Index>(std::round((1.7 - *offset) / every));
      Index found = 0, all = 0;
      for (Index n = 1; row_of(n) + 1 < kRows; ++n, ++all)
        found +=
            std::abs(static_cast<Index>(*offset + static_cast<double>(n + skipped) * cycle + 1e-6) -
                     row_of(n)) <= 1;
      CHECK(found >= all - all / 20);
    }
  }
}

}  // namespace
}  // namespace mpm::historian_test
