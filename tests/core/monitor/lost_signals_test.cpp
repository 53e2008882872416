#include "core/monitor/lost_signals.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace mpm {
namespace {

constexpr int kLags = 20;

/// One MV and one CV; the CV is as `quality` says, a sample a second.
struct Scene {
  LostSignals lost{SignalCounts{1, 0, 1, 0}, kLags};
  Frame frame{SignalCounts{1, 0, 1, 0}};

  void sample(Quality quality, double value = 1.0) {
    frame.source_time_ns += 1'000'000'000;
    frame[SignalKind::kMv].quality[0] = Quality::kGood;
    frame[SignalKind::kCv].quality[0] = quality;
    frame[SignalKind::kCv].values(0) = value;
    lost.take(frame, SignalKind::kMv, 0, frame[SignalKind::kMv].usable(0));
    lost.take(frame, SignalKind::kCv, 0, frame[SignalKind::kCv].usable(0));
  }
  void samples(int count, Quality quality) {
    for (int i = 0; i < count; ++i) sample(quality);
  }
};

}  // namespace

TEST_CASE("a signal that stays bad is lost since its first bad value, and found again") {
  Scene scene;
  scene.samples(10, Quality::kGood);
  scene.samples(kLags, Quality::kBad);
  CHECK(scene.lost.list().empty());
  scene.samples(2 * kLags, Quality::kBad);
  REQUIRE(scene.lost.list().size() == 1);
  const LostSignal lost = scene.lost.list().front();
  CHECK(lost.kind == SignalKind::kCv);
  CHECK(lost.cause == LossCause::kQuality);
  CHECK(lost.since_ns == 11'000'000'000);
  CHECK(lost.last_ns == 70'000'000'000);
  scene.samples(5, Quality::kGood);  // not yet
  CHECK(scene.lost.list().size() == 1);
  scene.samples(5 * kLags, Quality::kGood);
  CHECK(scene.lost.list().empty());
}

TEST_CASE("a few bad values lose no signal, and a good one now and then does not find it") {
  Scene scene;
  for (int i = 0; i < 1000; ++i) {
    scene.sample(i % 5 == 0 ? Quality::kBad : Quality::kGood);
    CHECK(scene.lost.list().empty());
  }
  scene.samples(200, Quality::kBad);
  for (int i = 0; i < 1000; ++i) {
    scene.sample(i % 10 == 0 ? Quality::kGood : Quality::kBad);
    CHECK(scene.lost.list().size() == 1);
  }
}

TEST_CASE("why a signal is lost is told apart") {
  Scene scene;
  scene.samples(100, Quality::kImplausible);
  REQUIRE(scene.lost.list().size() == 1);
  CHECK(scene.lost.list().front().cause == LossCause::kImplausible);
  scene.sample(Quality::kBad, std::numeric_limits<double>::quiet_NaN());
  CHECK(scene.lost.list().front().cause == LossCause::kNoValue);
}

}  // namespace mpm
