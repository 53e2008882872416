#include "core/signal/aligner.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/signal/aligner_bench.hpp"

namespace mpm::aligner_test {
namespace {

using Bench = test::AlignerBench;
using test::Block, test::Seen;
using test::kCounts, test::kKinds, test::needed_kinds, test::range;

}  // namespace

TEST_CASE("aligner: complete intervals come out once each, in order, at once after the start") {
  Bench bench;
  bench.push_all(100, 107);
  CHECK(bench.frames.empty());  // something of 92..99 could still come
  bench.push_all(108, 108);
  CHECK(bench.intervals() == range(100, 108));
  bench.push_all(109, 110);
  CHECK(bench.intervals().back() == 110);
  CHECK(bench.aligner.counters().frames == 11);
  CHECK(bench.aligner.counters().missing == 0);
  CHECK(bench.aligner.counters().incomplete == 0);
}

TEST_CASE("aligner: frames do not depend on the order of arrival within the lateness") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  AlignerSettings settings;
  for (int round = 0; round < 300; ++round) {
    settings.max_lateness = 1 + static_cast<int>(random() % 10);
    settings.capacity = 24 + static_cast<int>(random() % 100);
    // Content: some blocks and some whole intervals are lost, never at the ends.
    std::vector<Block> blocks;
    const std::int64_t first = static_cast<std::int64_t>(random() % 1000) - 500;
    const std::int64_t last = first + 80;
    for (std::int64_t k = first; k <= last; ++k) {
      const bool at_end = k == first || k > last - 2 * settings.max_lateness - 2;
      const bool interval_lost = !at_end && random() % 10 == 0;
      for (const SignalKind kind : kKinds)
        if (!interval_lost && (at_end || random() % 10 != 0)) blocks.push_back({kind, k});
    }
    Bench in_order(settings);
    for (const Block& block : blocks) in_order.push(block.kind, block.interval);

    // Sorting by interval + uniform delay moves no block past one that is a lateness newer.
    std::vector<std::pair<double, Block>> delayed;
    delayed.reserve(blocks.size());
    std::uniform_real_distribution<double> delay(0.0, settings.max_lateness);
    for (const Block& block : blocks)
      delayed.emplace_back(static_cast<double>(block.interval) + delay(random), block);
    std::sort(delayed.begin(), delayed.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    Bench shuffled(settings);
    for (const auto& [when, block] : delayed) shuffled.push(block.kind, block.interval);

    REQUIRE(in_order.frames == shuffled.frames);
    REQUIRE(in_order.frames.back().interval == last);
    CHECK(in_order.aligner.counters().missing == shuffled.aligner.counters().missing);
    CHECK(in_order.aligner.counters().incomplete == shuffled.aligner.counters().incomplete);
    CHECK(shuffled.aligner.counters().late == 0);
    CHECK(shuffled.aligner.counters().repeated == 0);
  }
}

TEST_CASE("aligner: an interval that lacks a block comes out with bad values, after the lateness") {
  Bench bench;
  bench.push_all(0, 19);
  bench.push(SignalKind::kMv, 20);
  bench.push(SignalKind::kPrediction, 20);
  bench.push_all(21, 28);
  CHECK(bench.intervals().back() == 19);
  bench.push_all(29, 29);
  CHECK(bench.intervals() == range(0, 29));
  CHECK(bench.aligner.counters().incomplete == 1);
  const auto without = [&](SignalKind kind) {
    return bench.aligner.counters().without[static_cast<std::size_t>(kind)];
  };
  CHECK(without(SignalKind::kCv) == 1);
  CHECK(without(SignalKind::kMv) + without(SignalKind::kPrediction) == 0);
  CHECK(without(SignalKind::kSetpoint) == 0);                   // nobody needs it
  const std::vector<double>& values = bench.frames[20].values;  // mv mv cv prediction setpoint
  REQUIRE(values.size() == 5);
  CHECK(values[0] == 200.0);
  CHECK(std::isnan(values[2]));
  CHECK(values[3] == 203.0);
  CHECK(std::isnan(values[4]));

  bench.push(SignalKind::kCv, 20);
  CHECK(bench.aligner.counters().late == 1);
  CHECK(bench.frames.size() == 30);
}

TEST_CASE("aligner: an interval of which nothing came is left out and counted") {
  Bench bench;
  bench.push_all(0, 19);
  bench.push_all(23, 40);
  std::vector<std::int64_t> expected = range(0, 19);
  for (const std::int64_t k : range(23, 40)) expected.push_back(k);
  CHECK(bench.intervals() == expected);
  CHECK(bench.aligner.counters().missing == 3);
}

TEST_CASE("aligner: of two blocks of one interval the first counts, before and after settling") {
  Bench bench;
  bench.push_all(0, 19);
  bench.push(SignalKind::kMv, 20);
  bench.push(SignalKind::kMv, 20, 0.25);
  bench.push(SignalKind::kCv, 20);
  bench.push(SignalKind::kPrediction, 20);
  bench.push(SignalKind::kMv, 20, 0.25);
  CHECK(bench.aligner.counters().repeated == 2);
  CHECK(bench.aligner.counters().late == 0);
  CHECK(bench.frames.back().values[0] == 200.0);
}

TEST_CASE("aligner: blocks that come after newer ones of their kind are used and counted") {
  Bench bench;
  bench.push_all(0, 19);
  for (const std::int64_t k : {22, 20, 21})
    for (const SignalKind kind : kKinds) bench.push(kind, k);
  CHECK(bench.intervals() == range(0, 22));
  CHECK(bench.aligner.counters().out_of_order == 6);
}

TEST_CASE("aligner: wrong sizes and absurd numbers are refused, non-finite values become bad") {
  Bench bench;
  const std::vector<double> values(5, 1.0);
  bench.aligner.push({SignalKind::kMv, 0, 0, std::span(values).first(3), {}});
  bench.aligner.push({SignalKind::kMv, 0, 0, {}, {}});
  const std::vector<std::uint8_t> one_quality(1, 0);
  bench.aligner.push({SignalKind::kMv, 0, 0, std::span(values).first(2), one_quality});
  bench.aligner.push({SignalKind::kMv,
                      std::numeric_limits<std::int64_t>::max(),
                      0,
                      std::span(values).first(2),
                      {}});
  bench.aligner.push({SignalKind::kMv,
                      std::numeric_limits<std::int64_t>::min(),
                      0,
                      std::span(values).first(2),
                      {}});
  CHECK(bench.aligner.counters().wrong_length == 3);
  CHECK(bench.aligner.counters().beyond == 2);
  CHECK_FALSE(bench.aligner.pending());

  bench.push_all(0, 19);
  const std::array<double, 2> odd = {std::numeric_limits<double>::infinity(), 7.0};
  const std::array<std::uint8_t, 2> quality = {0, 192};
  bench.aligner.push({SignalKind::kMv, 20, 0, odd, quality});
  bench.push(SignalKind::kCv, 20);
  bench.push(SignalKind::kPrediction, 20);
  CHECK(bench.aligner.counters().non_finite == 1);
  CHECK(std::isnan(bench.frames.back().values[0]));
  CHECK(std::isnan(bench.frames.back().values[1]));
}

TEST_CASE("aligner: kinds of unneeded topics are ignored") {
  Bench bench;
  bench.push(SignalKind::kSetpoint, 1'000'000);
  bench.push_all(0, 9);
  CHECK(bench.intervals() == range(0, 9));
}

AlignerSettings with_setpoints() {
  AlignerSettings settings;
  settings.welcome[static_cast<std::size_t>(SignalKind::kSetpoint)] = true;
  return settings;
}

TEST_CASE("aligner: a welcome kind is awaited while it comes, as late as it may") {
  Bench bench(with_setpoints());
  for (std::int64_t k = 100; k <= 140; ++k) {
    bench.push_all(k, k);
    if (k >= 105) bench.push(SignalKind::kSetpoint, k - 5);
  }
  CHECK(bench.intervals() == range(100, 135));
  for (const Seen& seen : bench.frames)
    CHECK(seen.values.back() ==
          10.0 * static_cast<double>(seen.interval) + static_cast<double>(SignalKind::kSetpoint));
}

TEST_CASE("aligner: nobody misses a welcome kind that does not come") {
  Bench bench(with_setpoints());
  bench.push_all(100, 120);
  CHECK(bench.frames.empty());  // it might come
  bench.aligner.expire();
  CHECK(bench.intervals() == range(100, 120));
  bench.push_all(121, 130);
  CHECK(bench.intervals() == range(100, 130));  // at once
  // Now and then it comes, and holds up nothing.
  for (std::int64_t k = 131; k <= 160; ++k) {
    if (k % 10 == 0) bench.push(SignalKind::kSetpoint, k);
    bench.push_all(k, k);
    CHECK(bench.intervals().back() == k);
  }
  CHECK(bench.aligner.counters().incomplete == 0);
  // Once it comes in adjacent intervals it is awaited again, until it stops.
  bench.push(SignalKind::kSetpoint, 161);
  bench.push(SignalKind::kSetpoint, 162);
  bench.push_all(161, 175);
  CHECK(bench.intervals().back() == 162);
  bench.aligner.expire();
  CHECK(bench.intervals() == range(100, 175));
  CHECK(bench.aligner.counters().incomplete == 0);
}

TEST_CASE("aligner: a kind may run ahead of the others by the capacity") {
  Bench bench(AlignerSettings{8, 256});
  bench.push_all(0, 19);
  for (std::int64_t k = 20; k < 220; ++k) bench.push(SignalKind::kMv, k);
  CHECK(bench.intervals() == range(0, 19));
  for (std::int64_t k = 20; k < 220; ++k) {
    bench.push(SignalKind::kCv, k);
    bench.push(SignalKind::kPrediction, k);
  }
  CHECK(bench.intervals() == range(0, 219));
  CHECK(bench.aligner.counters().incomplete == 0);
}

TEST_CASE(
    "aligner: a kind that falls silent holds nothing up once it is given up, until it is back") {
  Bench bench;
  bench.push_all(0, 19);
  for (std::int64_t k = 20; k < 60; ++k) {
    bench.push(SignalKind::kMv, k);
    bench.push(SignalKind::kCv, k);
  }
  CHECK(bench.intervals() == range(0, 19));
  CHECK(bench.aligner.pending());
  bench.aligner.expire();
  CHECK(bench.intervals() == range(0, 50));
  bench.push(SignalKind::kMv, 60);
  bench.push(SignalKind::kCv, 60);
  CHECK(bench.intervals() == range(0, 51));
  bench.push_all(61, 80);
  CHECK(bench.intervals() == range(0, 80));
  CHECK(bench.aligner.counters().incomplete == 41);
}

TEST_CASE("aligner: what was awaited for too long does not hold back complete frames") {
  Bench bench;
  bench.push_all(0, 4);  // fewer than the lateness
  CHECK(bench.frames.empty());
  bench.aligner.expire();
  CHECK(bench.intervals() == std::vector<std::int64_t>{0, 1, 2, 3, 4});
  bench.push(SignalKind::kMv, 6);  // of 5 nothing comes, of 6 and 9 only one block
  bench.push_all(7, 8);
  bench.push(SignalKind::kMv, 9);
  CHECK(bench.frames.size() == 5);
  bench.aligner.expire();
  CHECK(bench.intervals() == std::vector<std::int64_t>{0, 1, 2, 3, 4, 6, 7, 8});
  CHECK(bench.aligner.counters().incomplete == 1);
  CHECK(bench.aligner.counters().missing == 1);
  bench.push(SignalKind::kCv, 9);  // was still awaited
  bench.push(SignalKind::kPrediction, 9);
  CHECK(bench.intervals().back() == 9);
}

TEST_CASE("aligner: nothing is allocated after construction, whatever comes") {
  int frames = 0;
  Aligner aligner(kCounts, needed_kinds(), [&](const Frame&) { ++frames; });
  const std::array<double, 2> values = {1.0, 2.0};
  const std::uint64_t before = test::allocation_count();
  for (const std::int64_t first : {0, 50'000, 100}) {  // a start, a long absence, a restart
    for (std::int64_t k = first; k < first + 3000; ++k)
      for (const SignalKind kind : kKinds)
        aligner.push(
            {kind, k, 0, std::span(values).first(static_cast<std::size_t>(kCounts.of(kind))), {}});
    aligner.expire();
  }
  CHECK(test::allocation_count() == before);
  CHECK(frames == 9000);
}

TEST_CASE("aligner: any stream of numbers gives increasing frames") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  for (int round = 0; round < 200; ++round) {
    Bench bench(AlignerSettings{1 + static_cast<int>(random() % 5), 16});
    std::int64_t centre = 0;
    for (int i = 0; i < 2000; ++i) {
      if (random() % 200 == 0) centre = static_cast<std::int64_t>(random() % 20000) - 10000;
      if (random() % 3 == 0) ++centre;
      bench.push(kKinds[random() % 3], centre + static_cast<std::int64_t>(random() % 7));
      if (random() % 100 == 0) bench.aligner.expire();
    }
    const std::vector<std::int64_t> seen = bench.intervals();
    REQUIRE(!seen.empty());
    REQUIRE(std::adjacent_find(seen.begin(), seen.end(), std::greater_equal<>()) == seen.end());
    REQUIRE(bench.aligner.counters().frames == seen.size());
  }
}

// What a broken controller or an attacker may send. Each leap forward to the end of the numbers and
// each return would add 2^53 to what was emitted before: after a thousand of them int64 is full.
TEST_CASE("intervals that leap to and fro never run away") {
  constexpr std::int64_t kEnd = std::int64_t{1} << 53;
  constexpr int kLeaps = 3000, kLength = 40;
  Bench bench;
  for (int leap = 0; leap < kLeaps; ++leap) {
    const std::int64_t first = leap % 2 == 0 ? -kEnd : kEnd - kLength + 1;
    bench.push_all(first, first + kLength - 1);
  }
  bench.aligner.finish();
  CHECK(bench.frames.size() == std::size_t{kLeaps} * kLength);
  const std::vector<std::int64_t> intervals = bench.intervals();
  CHECK(std::adjacent_find(intervals.begin(), intervals.end(), std::greater_equal<>()) ==
        intervals.end());
  // The last numbers there are, and then per leap its length and a gap of the lateness.
  CHECK(intervals.back() <= kEnd + std::int64_t{kLeaps} * 2 * kLength);
}

}  // namespace mpm::aligner_test
