#include "core/statistics/reading_cycle.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include "core/archive/archive.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::reading_cycle_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kRows = 3000;

/// What the n-th reading shows, rounded to `quantum` (0: not).
double shown(std::int64_t n, double quantum = 0.0) {
  const double value = test::coloured(31, n);
  return quantum > 0.0 ? quantum * std::round(value / quantum) : value;
}

/// The rows that were taken for readings, and how many cycles they make.
struct Found {
  std::vector<std::int64_t> rows;
  std::int64_t cycles = 0;
};

template <class Value>
Found readings_in(ReadingCycle& cycle, std::int64_t rows, Value value) {
  Found found;
  for (std::int64_t k = 0; k < rows; ++k)
    if (const auto reading = cycle.take(k, value(k))) {
      found.rows.push_back(k);
      found.cycles += reading->cycles;
      CHECK(reading->value == value(k));
    }
  return found;
}

}  // namespace

TEST_CASE("a signal that is read in a cycle is known after twenty readings, and each is found") {
  const double every = GENERATE(2.0, 2.5, 3.0, 4.97, 5.03, 7.0, 7.4, 10.0, 10.3, 24.6, 60.0);
  const double offset = GENERATE(0.0, 1.0);
  ReadingCycle cycle;
  const auto number = [&](std::int64_t k) {
    return static_cast<std::int64_t>(std::floor((static_cast<double>(k) + offset) / every));
  };
  const Found found = readings_in(cycle, kRows, [&](std::int64_t k) { return shown(number(k)); });
  // Of twenty spacings of whole rows a mean is known to 1 / 20 of a row.
  CHECK(std::abs(cycle.samples() - every) < 0.051);
  const std::int64_t all = number(kRows - 1);
  CHECK(found.cycles == static_cast<std::int64_t>(found.rows.size()));
  CHECK(found.cycles >= all - 21);
  CHECK(found.cycles <= all);
  for (const std::int64_t row : found.rows) CHECK(number(row) == number(row - 1) + 1);
}

TEST_CASE("a reading that shows the same again is one, where it is due") {
  ReadingCycle cycle;
  constexpr std::int64_t kEvery = 10;
  const Found found =
      readings_in(cycle, kRows, [](std::int64_t k) { return shown(k / kEvery, 0.1); });
  std::int64_t same = 0;
  for (std::int64_t n = 1; n < kRows / kEvery; ++n) same += shown(n, 0.1) == shown(n - 1, 0.1);
  CHECK(same > 10);
  CHECK(found.cycles >= kRows / kEvery - 40);
  CHECK(found.cycles <= kRows / kEvery);
  for (const std::int64_t row : found.rows) CHECK(row % kEvery <= 1);
}

TEST_CASE("rows between readings may be blank") {
  ReadingCycle cycle;
  const Found found = readings_in(
      cycle, kRows, [](std::int64_t k) { return k % 6 == 2 ? shown(k / 6) : kUnknown; });
  CHECK(cycle.samples() == 6.0);
  for (const std::int64_t row : found.rows) CHECK(row % 6 == 2);
  CHECK(found.rows.size() >= kRows / 6 - 21);
}

TEST_CASE("what is read at every sample, or held by a deadband, has no cycle") {
  ReadingCycle every_sample, by_deadband, coarse, at_rest;
  double held = 0.0;
  for (std::int64_t k = 0; k < kRows; ++k) {
    const double value = shown(k);
    if (std::abs(value - held) > 1.5) held = value;
    CHECK_FALSE(every_sample.take(k, value));
    CHECK_FALSE(by_deadband.take(k, held));
    CHECK_FALSE(coarse.take(k, shown(k, 2.0)));
    CHECK_FALSE(at_rest.take(k, 5.0));
  }
}

TEST_CASE("a cycle that ends is over, and another one is found") {
  ReadingCycle cycle;
  readings_in(cycle, 400, [](std::int64_t k) { return shown(k / 5); });
  CHECK(cycle.samples() == 5.0);
  for (std::int64_t k = 400; k < 440; ++k) (void)cycle.take(k, shown(k));
  CHECK(cycle.samples() == 0.0);
  for (std::int64_t k = 440; k < 1500; ++k) (void)cycle.take(k, shown(k / 12));
  CHECK(cycle.samples() == 12.0);
}

TEST_CASE("a value between two readings is none, and the next ones are found again") {
  ReadingCycle cycle;
  std::set<std::int64_t> rows;
  for (std::int64_t k = 0; k < 1000; ++k)
    if (cycle.take(k, k == 503 || k == 504 ? 99.0 + static_cast<double>(k) : shown(k / 10)))
      rows.insert(k);
  CHECK_FALSE(rows.contains(503));
  for (std::int64_t k = 520; k < 1000; k += 10) CHECK(rows.contains(k));
}

TEST_CASE("what it has learnt is put away and taken back") {
  const auto value = [](std::int64_t k) { return shown(k / 7); };
  ReadingCycle whole, first, then;
  for (std::int64_t k = 0; k < 333; ++k) {
    (void)whole.take(k, value(k));
    (void)first.take(k, value(k));
  }
  take_back(put_away(first), then);
  for (std::int64_t k = 333; k < 700; ++k)
    CHECK(then.take(k, value(k)).has_value() == whole.take(k, value(k)).has_value());
  CHECK(put_away(then) == put_away(whole));
}

TEST_CASE("bytes of a cycle that cannot be are refused") {
  ReadingCycle cycle;
  for (std::int64_t k = 0; k < 333; ++k) (void)cycle.take(k, shown(k / 7));
  const std::vector<std::byte> bytes = put_away(cycle);
  int refused = 0;
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
    std::vector<std::byte> damaged = bytes;
    for (std::size_t i = 0; i < 8; ++i)
      damaged[at + i] = i == 7 ? std::byte{0x7F} : std::byte{0xFF};
    ReadingCycle back;
    try {
      take_back(damaged, back);
      (void)back.take(334, 5.0);
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  // Every number but the last value, which may be any.
  CHECK(refused == static_cast<int>(bytes.size() / 8) - 1);
}

}  // namespace mpm::reading_cycle_test
