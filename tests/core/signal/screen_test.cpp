#include "core/signal/screen.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::screen_test {
namespace {

const SignalCounts kCounts{1, 0, 1, 0};

// 1000 samples of a noisy unit; `spoil` falsifies a frame. Returns which CV values got through.
std::vector<bool> usable(Screen& screen, const std::function<void(int, Frame&)>& spoil,
                         double resolution = 0.0) {
  std::vector<bool> passed;
  double noise = 0.0;
  for (int k = 0; k < 1000; ++k) {
    Frame frame(kCounts);
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    frame.interval = k;
    noise = 0.9 * noise + 0.1 * test::uniform(40, k);
    const auto rounded = [&](double value) {
      return resolution > 0.0 ? std::round(value / resolution) * resolution : value;
    };
    frame[SignalKind::kMv].values(0) = test::uniform(41, k);
    frame[SignalKind::kPrediction].values(0) = std::sin(0.01 * k);
    frame[SignalKind::kCv].values(0) = rounded(std::sin(0.01 * k) + noise);
    spoil(k, frame);
    screen.push(frame);
    while (const Frame* out = screen.next()) {
      CHECK(out->interval == static_cast<int>(passed.size()));
      passed.push_back((*out)[SignalKind::kCv].usable(0));
    }
  }
  return passed;
}

int rejected(const std::vector<bool>& passed) {
  return static_cast<int>(std::count(passed.begin(), passed.end(), false));
}

TEST_CASE("what a process gives passes the screen") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  CHECK(rejected(usable(screen, [](int, Frame&) {})) == 0);
  // A coarse sensor repeats itself. Until it is known to be coarse a
  // few are lost.
  for (const double resolution : {0.02, 0.1}) {
    Screen coarse(kCounts, {true}, {true}, 0, 30);
    CAPTURE(resolution);
    CHECK(rejected(usable(
              coarse, [](int, Frame&) {}, resolution)) < 20);
  }
}

TEST_CASE(
    "how often a coarse sensor repeats itself is known, and no frozen one passes for coarse") {
  // Counted here: of 999 values those that equal the one before.
  for (const double resolution : {0.02, 0.1}) {
    CAPTURE(resolution);
    Screen screen(kCounts, {true}, {true}, 0, 30);
    double last = 0.0;
    int same = 0;
    usable(
        screen,
        [&](int k, Frame& frame) {
          const double value = frame[SignalKind::kCv].values(0);
          same += k > 0 && value == last ? 1 : 0;
          last = value;
        },
        resolution);
    CHECK(same > 80);
    CHECK(screen.repeated_share(0) == Approx(same / 999.0).margin(0.06));
  }
  Screen fine(kCounts, {true}, {true}, 0, 30);
  usable(fine, [](int k, Frame& frame) {
    if (k > 300) frame[SignalKind::kCv].values(0) = 0.25;
  });
  CHECK(fine.repeated_share(0) == 0.0);
}

TEST_CASE("a frozen sensor is caught from its first repetition on, and let go at once") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  double stuck = 0.0;
  const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
    if (k == 500) stuck = frame[SignalKind::kCv].values(0);
    if (k > 500 && k < 560) frame[SignalKind::kCv].values(0) = stuck;
  });
  for (std::size_t k = 0; k < passed.size(); ++k) CHECK(passed[k] == !(k > 500 && k < 560));
  CHECK(screen.counters().frozen == 59);
}

// As values with few digits do by chance.
TEST_CASE("a value that comes twice is no frozen sensor, one that comes three times is") {
  for (const int times : {2, 3}) {
    Screen screen(kCounts, {true}, {true}, 0, 30);
    double first = 0.0;
    const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
      double& value = frame[SignalKind::kCv].values(0);
      if (k % 100 == 50) first = value;
      if (k % 100 >= 50 && k % 100 < 50 + times) value = first;
    });
    CAPTURE(times);
    CHECK(rejected(passed) == (times == 2 ? 0 : 20));
    CHECK(screen.counters().frozen == (times == 2 ? 0 : 20));
  }
}

TEST_CASE("values at the end of an instrument's range are caught") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  int clipped = 0;
  const std::vector<bool> passed = usable(screen, [&](int, Frame& frame) {
    double& value = frame[SignalKind::kCv].values(0);
    if (value > 0.95) ++clipped;
    value = std::min(value, 0.95);
  });
  REQUIRE(clipped > 100);
  CHECK(rejected(passed) >= clipped - 8);  // the first few, before the end is known
  CHECK(rejected(passed) <= clipped);
}

TEST_CASE("spikes of one and two samples are caught, steps are not") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
    double& value = frame[SignalKind::kCv].values(0);
    if (k == 300) value += 3.0;
    if (k == 400 || k == 401) value -= 3.0;
    if (k >= 600) value += 3.0;
  });
  for (std::size_t k = 0; k < passed.size(); ++k)
    CHECK(passed[k] == (k != 300 && k != 400 && k != 401));
  CHECK(screen.counters().spikes == 3);
}

// As where one MV's move is made up for by another's: it turns within two samples, but not at once.
TEST_CASE("a process that turns around quickly gives no spike") {
  Screen screen(kCounts, {false}, {true}, 0, 30);
  const std::vector<double> turn = {0.1, 0.25, 0.5, 0.8, 1.1, 0.95, 0.7, 0.5, 0.3, 0.15, 0.05};
  const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
    const auto since = static_cast<std::size_t>(k % 100);
    if (k > 100 && since < turn.size()) frame[SignalKind::kCv].values(0) += turn[since];
  });
  CHECK(rejected(passed) == 0);
}

// As the front in a column that swings: the peak is far above the noise, but so is the way to it.
TEST_CASE("the peak of a quick wave is no spike, with predictions that know nothing of it") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  const std::vector<double> wave = {0.1, 0.3, 0.8, 1.6, 3.1, 5.2, 7.6, 6.8,
                                    4.9, 3.6, 2.7, 1.5, 0.8, 0.4, 0.2, 0.1};
  const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
    const auto since = static_cast<std::size_t>(k % 100);
    if (k > 100 && since < wave.size()) frame[SignalKind::kCv].values(0) -= wave[since];
  });
  CHECK(rejected(passed) == 0);
}

/// How many values of an MV are lost that is uniform in -1..1 and at `value` where it is away.
int lost_of_mv(int samples, double value, const std::function<bool(int)>& away) {
  Screen screen(kCounts, {false}, {true}, 0, 30);
  int lost = 0;
  for (int k = 0; k < samples; ++k) {
    Frame frame(kCounts);
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    frame.interval = k;
    frame[SignalKind::kMv].values(0) = away(k) ? value : test::uniform(41, k);
    frame[SignalKind::kCv].values(0) = test::uniform(42, k);
    screen.push(frame);
    while (const Frame* out = screen.next()) lost += (*out)[SignalKind::kMv].usable(0) ? 0 : 1;
  }
  return lost;
}

TEST_CASE("an input that leaves its range for a sample or two is marked, unless that is its way") {
  const int length = GENERATE(1, 2, 3);
  const double value = GENERATE(1.5, 4.0, -4.0);
  CAPTURE(length, value);
  const bool pulse = length <= 2 && std::abs(value) > 3.0;
  const auto rarely = [&](int k) { return k % 500 >= 100 && k % 500 < 100 + length; };
  CHECK(lost_of_mv(2000, value, rarely) == (pulse ? 4 * length : 0));
  // One in twenty: the first kMost, and perhaps one for what the count forgets meanwhile.
  const auto often = [](int k) { return k > 100 && k % 20 == 0; };
  CHECK(lost_of_mv(4000, value, often) <= 11);
}

TEST_CASE("a controller in manual is no frozen sensor") {
  for (const bool predicted : {true, false}) {
    Screen screen(kCounts, {predicted}, {true}, 0, 30);
    int lost = 0;
    const std::vector<bool> passed = usable(screen, [&](int k, Frame& frame) {
      if (k < 400) return;
      frame[SignalKind::kMv].values(0) = 0.123;
      frame[SignalKind::kPrediction].values(0) = 0.5;
    });
    lost = rejected(passed);
    CHECK(lost == 0);
    CHECK(screen.counters().frozen == 0);
  }
}

// A pump that is switched, a step a thousand times the usual movement, and what settles without
// noise: all that is learnt of them stays.
TEST_CASE("what a process does in its first samples is never taken for wild") {
  const std::vector<std::function<double(int)>> ways = {
      [](int k) { return k < 50 ? 0.0 : 1.0; },
      [](int k) { return (k < 50 ? 0.0 : 1000.0) + test::uniform(43, k); },
      [](int k) { return 1e6 * std::exp(-k / 20.0); },
      [](int k) { return k % 200 < 40 ? 1e6 : 0.0; }};
  for (std::size_t way = 0; way < ways.size(); ++way) {
    CAPTURE(way);
    Screen screen(kCounts, {true}, {true}, 0, 30);
    int anew = 0;
    usable(screen, [&](int k, Frame& frame) {
      anew += screen.anew() ? 1 : 0;  // with the frame before
      frame[SignalKind::kMv].values(0) = ways[way](k);
    });
    CHECK(anew == 0);
  }
}

TEST_CASE("the screen allocates nothing per frame") {
  Screen screen(kCounts, {true}, {true}, 0, 30);
  Frame frame(kCounts);
  const std::uint64_t before = test::allocation_count();
  for (int k = 0; k < 100; ++k) {
    frame.interval = k;
    screen.push(frame);
    while (screen.next() != nullptr) {
    }
  }
  CHECK(test::allocation_count() == before);
}

// The usual difference is then mostly 0, and a step of the sensor many times that.
TEST_CASE("a step of a sensor that mostly repeats is no spike") {
  for (const bool with_prediction : {false, true}) {
    Screen screen(kCounts, {with_prediction}, {true}, 0, 30);
    double noise = 0.0;
    for (int k = 0; k < 4000; ++k) {
      Frame frame(kCounts);
      for (SignalBlock& block : frame.blocks)
        std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
      if (!with_prediction) frame[SignalKind::kPrediction].quality[0] = Quality::kBad;
      frame.interval = k;
      noise = 0.9 * noise + 0.02 * test::uniform(43, k);
      frame[SignalKind::kMv].values(0) = test::uniform(44, k);
      frame[SignalKind::kPrediction].values(0) = 0.3 * std::sin(0.02 * k);
      frame[SignalKind::kCv].values(0) = 0.1 * std::round((0.3 * std::sin(0.02 * k) + noise) / 0.1);
      screen.push(frame);
      while (screen.next() != nullptr) {
      }
    }
    CHECK(screen.repeated_share(0) > 0.6);
    CHECK(screen.spikes(0) <= 2);
  }
}

}  // namespace
}  // namespace mpm::screen_test
