#include "core/performance/performance_window.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "tests/allocation_counter.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/performance/made_unit.hpp"

namespace mpm {
namespace {

using calibration::performance::kBlocks;

/// Frames with noise, holes and, twice, gaps; the reading of a frame is its CV.
struct Frames {
  std::vector<Frame> frames;
  std::vector<JudgedFrame> judged;

  explicit Frames(int count) {
    for (int k = 0; k < count; ++k) {
      if ((k > 400 && k < 420) || (k > 800 && k < 1100)) continue;
      const auto noise = [k](std::uint64_t stream) { return test::uniform(stream, k); };
      const double y = k % 17 == 0 ? test::kUnknown : 5.0 + noise(1);
      frames.push_back(test::made_frame(k, 50.0 + 60.0 * noise(2), k < 600 ? noise(3) : 0.0, y,
                                        k % 23 == 0 ? test::kUnknown : 5.0));
      judged.push_back({k, {CvReading{y, y - 5.0}}});
    }
  }
};

void check_equal(const PerformanceSums& a, const PerformanceSums& b) {
  CHECK(a.samples == b.samples);
  CHECK(a.told == b.told);
  CHECK(a.acting == b.acting);
  CHECK(a.cvs[0].known == b.cvs[0].known);
  CHECK(a.cvs[0].outside == b.cvs[0].outside);
  CHECK(a.cvs[0].error.count() == b.cvs[0].error.count());
  if (b.cvs[0].error.count() > 1) {
    CHECK(a.cvs[0].error.mean() == Approx(b.cvs[0].error.mean()).margin(1e-13));
    CHECK(a.cvs[0].error.variance() == Approx(b.cvs[0].error.variance()).epsilon(1e-12));
  }
  for (std::size_t h = 0; h < 2; ++h) {
    CHECK(a.cvs[0].predictions[h].pairs == b.cvs[0].predictions[h].pairs);
    CHECK(a.cvs[0].predictions[h].error_square ==
          Approx(b.cvs[0].predictions[h].error_square).epsilon(1e-12));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(a.mvs[i].known == b.mvs[i].known);
    CHECK(a.mvs[i].at_limits == b.mvs[i].at_limits);
    CHECK(a.mvs[i].standing == b.mvs[i].standing);
    CHECK(a.mvs[i].moves == b.mvs[i].moves);
    CHECK(a.mvs[i].travel == Approx(b.mvs[i].travel).epsilon(1e-12));
  }
}

TEST_CASE("a window has at least a hundred samples, in equal blocks") {
  CHECK(PerformanceWindow(test::made_setup(), 1.0).samples() == 3 * kBlocks);
  CHECK(PerformanceWindow(test::made_setup(), 28800.0).samples() == 28800);
  CHECK(PerformanceWindow(test::made_setup(), 28801.0).samples() == 28848);
  CHECK(PerformanceWindow(test::made_setup(), 1e300).samples() > 0);
}

TEST_CASE("what slides out of the window is as if it had never been") {
  const Frames made(1500);
  PerformanceWindow window(test::made_setup(), 96.0);
  const std::int64_t length = window.samples(), block = length / kBlocks;
  int ends = 0;
  for (std::size_t at = 0; at < made.frames.size(); ++at) {
    const std::int64_t k = made.frames[at].interval;
    const bool ended = window.push(made.frames[at], {&made.judged[at], 1});
    CAPTURE(k);
    const bool after_gap = at > 0 && made.frames[at - 1].interval != k - 1 &&
                           made.frames[at - 1].interval % block != block - 1;
    CHECK(ended == ((k + 1) % block == 0 || after_gap));
    if (!ended) continue;
    ++ends;
    if (k % 30 != 29 && !after_gap) continue;  // these will do
    // The same samples once more, from scratch: only what is in the window is added up.
    PerformanceMeter meter(test::made_setup());
    PerformanceSums before(test::made_setup()), inside(test::made_setup());
    const std::int64_t from = (k / block + 1) * block - length;
    for (std::size_t i = 0; i <= at; ++i) {
      PerformanceSums& sums = made.frames[i].interval < from ? before : inside;
      meter.take(made.frames[i], sums);
      meter.judge(made.judged[i], sums);
    }
    check_equal(window.total(), inside);
  }
  CHECK(ends > 300);
}

TEST_CASE("a frame that is not newer leaves the window alone") {
  PerformanceWindow window(test::made_setup(), 100.0);
  const Frame frame = test::made_frame(7, 1.0, 2.0, 0.0, 0.0);
  CHECK_FALSE(window.push(frame, {}));
  CHECK_FALSE(window.push(frame, {}));
  CHECK(window.total().samples == 1);
}

// Where the value is unknown instead, nothing else differs: the range of a signal is that of the
// others. Waiting for the end of an excursion, a frame may leave after the last of these.
TEST_CASE("a value that no process gives is in the window as one that is unknown") {
  const Frames made(1500);
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kSetpoint}) {
    for (const double wild : {1e20, -1e99, 5e4}) {
      for (const int length : {1, 5}) {
        CAPTURE(static_cast<int>(kind), wild, length);
        PerformanceWindow window(test::made_setup(), 4800.0), twin(test::made_setup(), 4800.0);
        for (std::size_t at = 0; at < made.frames.size(); ++at) {
          Frame frame = made.frames[at];
          const std::int64_t k = frame.interval;
          const bool spoilt = k >= 700 && k < 700 + length;
          if (spoilt && frame[kind].usable(0)) frame[kind].values(0) = wild;
          window.push(frame, {});
          if (spoilt) frame[kind].quality[0] = Quality::kBad;
          twin.push(frame, {});
        }
        check_equal(window.total(), twin.total());
        CHECK(window.total().cvs[0].error.variance() < 1.0);
      }
    }
  }
}

TEST_CASE("wild values before a signal is known are forgotten once it is") {
  const Frames made(1500);
  PerformanceWindow window(test::made_setup(), 4800.0);
  for (std::size_t at = 0; at < made.frames.size(); ++at) {
    Frame frame = made.frames[at];
    JudgedFrame judged = made.judged[at];
    if (frame.interval == 12) {
      for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv}) frame[kind].values(0) = 1e20;
      judged.readings[0].measured = judged.readings[0].residual = 1e20;
    }
    window.push(frame, {&judged, 1});
  }
  const PerformanceSums& total = window.total();
  CHECK(total.samples > 1100);
  CHECK(total.cvs[0].error.variance() < 1.0);
  CHECK(total.cvs[0].predictions[0].rmse() < 2.0);
  CHECK(total.mvs[0].travel < 60.0 * 1500);
}

TEST_CASE("indices of control performance allocate nothing per sample") {
  const Frames made(1500);
  PerformanceWindow window(test::made_setup(), 100.0);
  std::int64_t samples = 0;
  const std::uint64_t before = test::allocation_count();
  for (std::size_t at = 0; at < made.frames.size(); ++at)
    if (window.push(made.frames[at], {&made.judged[at], 1})) samples += window.total().samples;
  CHECK(test::allocation_count() == before);
  CHECK(samples > 0);
}

}  // namespace
}  // namespace mpm
