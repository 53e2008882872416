// Numbers that begin anew, leap or stray: which ones the aligner follows.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <vector>

#include "tests/core/signal/aligner_bench.hpp"

namespace mpm::aligner_restart_test {
namespace {

using Bench = test::AlignerBench;
using test::kKinds, test::range;

}  // namespace

TEST_CASE("aligner: a controller that starts again is followed, with increasing numbers") {
  Bench bench;
  bench.push_all(5000, 5100);
  bench.push_all(0, 50);
  REQUIRE(bench.frames.size() == 152);
  CHECK(bench.aligner.counters().restarts == 1);
  CHECK(bench.aligner.counters().late == 0);
  const std::vector<std::int64_t> seen = bench.intervals();
  CHECK(std::is_sorted(seen.begin(), seen.end()));
  CHECK(seen[101] > seen[100] + 1);  // a gap, so that lag windows close
  CHECK(seen[151] == seen[101] + 50);
  CHECK(bench.frames[101].values[0] == 0.0);
  CHECK(bench.frames[101].source_time_ns == 0);
}

TEST_CASE("aligner: a controller that starts again just behind where it was is followed") {
  Bench in_turn;
  in_turn.push_all(1, 30);
  in_turn.clock_ns = 100'000;
  in_turn.push_all(1, 60);
  CHECK(in_turn.aligner.counters().restarts == 1);
  CHECK(in_turn.aligner.counters().late == 0);
  CHECK(in_turn.aligner.counters().repeated == 0);
  REQUIRE(in_turn.frames.size() == 90);
  CHECK(in_turn.frames[29].values[0] == 300.0);
  CHECK(in_turn.frames[30].values[0] == 10.0);
  CHECK(in_turn.frames[30].source_time_ns == 101'000);
  CHECK(in_turn.frames[30].interval > in_turn.frames[29].interval + 1);
  CHECK(in_turn.intervals().back() == in_turn.frames[30].interval + 59);

  // Whichever topic is read first, as where many samples have gathered.
  Bench by_kind;
  for (const SignalKind kind : kKinds) {
    by_kind.clock_ns = 0;
    for (std::int64_t k = 1; k <= 30; ++k) by_kind.push(kind, k);
    by_kind.clock_ns = 100'000;
    for (std::int64_t k = 1; k <= 60; ++k) by_kind.push(kind, k);
  }
  CHECK(by_kind.frames == in_turn.frames);
}

TEST_CASE(
    "aligner: a controller that starts again without a kind is followed once that is given up") {
  for (const std::int64_t first : {std::int64_t{1}, std::int64_t{90}, std::int64_t{500'000}}) {
    CAPTURE(first);
    Bench bench;
    bench.push_all(1, 100);
    bench.clock_ns = 1'000'000;  // the times go on
    for (std::int64_t k = first; k < first + 40; ++k) {
      bench.push(SignalKind::kMv, k);
      bench.push(SignalKind::kCv, k);
    }
    REQUIRE(bench.frames.size() == 100);
    CHECK(bench.aligner.pending());
    bench.aligner.expire();
    CHECK(bench.frames.size() > 100);
    for (std::int64_t k = first + 40; k < first + 60; ++k) {
      bench.push(SignalKind::kMv, k);
      bench.push(SignalKind::kCv, k);
    }
    REQUIRE(bench.frames.size() == 100 + 51);  // all but those that may still be late
    CHECK(bench.frames[100].values[0] == 10.0 * static_cast<double>(first));
    CHECK(bench.frames.back().values[0] == 10.0 * static_cast<double>(first + 50));
    CHECK(bench.aligner.counters().incomplete == 51);
    CHECK(bench.aligner.counters().late == 0);
    CHECK(bench.aligner.counters().restarts == (first < 100 ? 1 : 0));
    if (first < 100) {
      CHECK(bench.aligner.restart().from == 100);
      CHECK(bench.aligner.restart().to == first);
    }
    bench.push_all(first + 60, first + 80);  // it is back
    CHECK(bench.frames.size() == 100 + 81);
  }
}

TEST_CASE("aligner: what only stray numbers fill is not gone to when nothing comes") {
  Bench bench;
  bench.push_all(1, 100);
  bench.push(SignalKind::kMv, 9'000'000);
  bench.push(SignalKind::kMv, 9'000'000);
  bench.push(SignalKind::kCv, 9'000'001);
  CHECK_FALSE(bench.aligner.pending());
  bench.aligner.expire();
  bench.push_all(101, 120);
  CHECK(bench.intervals() == range(1, 120));
  // Nor what comes beside the numbers that go on.
  for (std::int64_t k = 121; k <= 160; ++k) {
    bench.push(SignalKind::kPrediction, k);
    bench.push(SignalKind::kMv, k - 100'000);
  }
  bench.aligner.expire();
  CHECK(bench.aligner.counters().restarts == 0);
}

TEST_CASE("aligner: a restart is told in the numbers that came, though frames count on") {
  Bench bench;
  bench.push_all(5000, 5100);
  bench.push_all(0, 50);
  bench.push_all(-1000, -990);
  CHECK(bench.aligner.counters().restarts == 2);
  CHECK(bench.aligner.restart().from == 50);
  CHECK(bench.aligner.restart().to == -1000);
}

TEST_CASE("aligner: late and repeated blocks are no new beginning, whoever sends them") {
  Bench late;
  late.push_all(0, 30);
  for (std::int64_t k = 10; k <= 30; ++k)  // again, as old as they were
    for (const SignalKind kind : kKinds) late.push(kind, k);
  late.push_all(31, 40);
  CHECK(late.intervals() == range(0, 40));
  CHECK(late.aligner.counters().restarts == 0);
  CHECK(late.aligner.counters().repeated == 63);

  // A second gateway that is five behind and whose clock is ahead: the first one goes on.
  Bench pair;
  for (std::int64_t k = 100; k <= 160; ++k) {
    pair.clock_ns = 0;
    pair.push_all(k, k);
    pair.clock_ns = 50'000;
    if (k >= 120) pair.push_all(k - 5, k - 5);
  }
  pair.clock_ns = 0;
  pair.push_all(161, 161);
  CHECK(pair.intervals() == range(100, 161));
  CHECK(pair.aligner.counters().restarts == 0);
  CHECK(pair.aligner.counters().repeated == 41 * 3);
  CHECK(pair.aligner.counters().late == 0);
  CHECK(pair.frames.back().values[0] == 1610.0);
}

TEST_CASE("aligner: a controller that was away is followed without a loss") {
  Bench bench;
  bench.push_all(0, 100);
  bench.push_all(1'000'000, 1'000'020);
  CHECK(bench.frames.size() == 122);
  CHECK(bench.intervals().back() == 1'000'020);
  CHECK(bench.aligner.counters().missing == 1'000'000 - 101);
  CHECK(bench.aligner.counters().restarts == 0);
}

TEST_CASE("aligner: no more is missing than the source times had room for") {
  AlignerSettings settings;
  settings.sample_time_ns = 1000.0;  // as `push` has it
  Bench bench(settings);
  bench.push_all(0, 100);
  bench.push_all(600, 700);  // as much time went by
  CHECK(bench.aligner.counters().missing == 499);
  bench.clock_ns = -999'000 * 1000;  // numbers leapt, time did not
  bench.push_all(1'000'000, 1'000'020);
  CHECK(bench.intervals().back() == 1'000'020);
  CHECK(bench.aligner.counters().missing == 499 + 299);  // from 700 s to 1000 s
  CHECK(bench.aligner.counters().restarts == 0);
}

TEST_CASE(
    "aligner: where numbers begin anew and times go on nothing is missing but what they leave "
    "out") {
  const std::int64_t away = GENERATE(0, 3, 50);  // intervals
  const bool forward = GENERATE(false, true);
  AlignerSettings settings;
  settings.sample_time_ns = 1000.0;  // as `push` has it
  Bench bench(settings);
  bench.push_all(0, 1000);
  const std::int64_t first = forward ? 500'000 : 200;
  bench.clock_ns = (1001 + away - first) * 1000;
  bench.push_all(first, first + 100);
  CHECK(bench.aligner.counters().restarts == (forward ? 0 : 1));
  // After a restart the numbers leave room for a few.
  CHECK(bench.aligner.counters().missing <= static_cast<std::uint64_t>(away));
  if (away == 0 || forward)
    CHECK(bench.aligner.counters().missing == static_cast<std::uint64_t>(away));
}

TEST_CASE(
    "aligner: a leap that no absence explains is a new beginning, not samples that are missing") {
  Bench bench;
  bench.push_all(0, 100);
  const std::int64_t far = std::int64_t{1} << 53;
  bench.push_all(far - 20, far);
  CHECK(bench.frames.size() == 122);
  CHECK(bench.aligner.counters().missing < 20);
  CHECK(bench.aligner.counters().restarts == 1);
}

TEST_CASE("aligner: a stray number changes nothing") {
  Bench bench;
  bench.push_all(0, 20);
  bench.push(SignalKind::kMv, 9'000'000'000);
  bench.push_all(21, 40);
  bench.push(SignalKind::kCv, -9'000'000'000);
  bench.push_all(41, 60);
  CHECK(bench.intervals() == range(0, 60));
  CHECK(bench.aligner.counters().restarts == 0);
  CHECK(bench.aligner.counters().late == 2);
}

// Topics are read in pieces, each as long as it happens to be.
void push_topic_by_topic(Bench& bench, std::span<const std::int64_t> numbers,
                         std::mt19937_64& random) {
  std::array<std::size_t, kKinds.size()> done{};
  while (std::ranges::min(done) < numbers.size())
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
      for (std::size_t left = random() % 90; left > 0 && done[kind] < numbers.size(); --left) {
        bench.clock_ns = (static_cast<std::int64_t>(done[kind]) - numbers[done[kind]]) * 1000;
        bench.push(kKinds[kind], numbers[done[kind]++]);
      }
}

TEST_CASE("aligner: a whole interval with a stray number is late, whichever topic is read first") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  for (const std::int64_t stray :
       std::vector<std::int64_t>{-9'000'000'000, -3600, 3600, 31'536'000}) {
    std::vector<std::int64_t> numbers = range(0, 300);
    numbers[150] += stray;
    std::vector<std::int64_t> expected = range(0, 300);
    expected.erase(expected.begin() + 150);
    for (int round = 0; round < 50; ++round) {
      Bench bench;
      push_topic_by_topic(bench, numbers, random);
      REQUIRE(bench.intervals() == expected);
      CHECK(bench.aligner.counters().incomplete == 0);
      CHECK(bench.aligner.counters().restarts == 0);
      CHECK(bench.aligner.counters().missing == 1);
      CHECK(bench.aligner.counters().late == 3);
    }
  }
}

TEST_CASE("aligner: of two counters in turn the first one is followed") {
  const unsigned seed = std::random_device{}();
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  std::vector<std::int64_t> numbers = range(0, 301);
  std::vector<std::int64_t> expected;
  for (std::int64_t& number : numbers)
    if (number % 2 == 0)
      expected.push_back(number);
    else
      number += 1'000'000;
  for (int round = 0; round < 50; ++round) {
    Bench bench;
    push_topic_by_topic(bench, numbers, random);
    bench.aligner.finish();
    REQUIRE(bench.intervals() == expected);
    CHECK(bench.aligner.counters().incomplete == 0);
  }
}

}  // namespace mpm::aligner_restart_test
