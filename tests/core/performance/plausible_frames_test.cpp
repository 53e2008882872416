#include "core/performance/plausible_frames.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/core/counter_noise.hpp"
#include "tests/core/performance/made_unit.hpp"

namespace mpm {
namespace {

Frame frame_of(std::int64_t k) {
  return test::made_frame(k, test::uniform(1, k), test::uniform(2, k), test::uniform(3, k), 5.0);
}

/// The intervals that leave; of the wild ones only as implausible.
std::vector<std::int64_t> leaving(PlausibleFrames& frames) {
  std::vector<std::int64_t> intervals;
  while (const Frame* frame = frames.next()) {
    intervals.push_back(frame->interval);
    for (const SignalBlock& block : frame->blocks)
      for (int i = 0; i < block.size(); ++i)
        if (block.usable(i)) CHECK(std::abs(block.values(i)) < 50.0);
  }
  return intervals;
}

using Intervals = std::vector<std::int64_t>;

TEST_CASE("a frame that is not newer is not taken") {
  PlausibleFrames frames(test::made_setup().counts);
  CHECK(frames.push(frame_of(5)));
  CHECK_FALSE(frames.push(frame_of(5)));
  CHECK_FALSE(frames.push(frame_of(4)));
  CHECK(frames.push(frame_of(6)));
  frames.end_run();
  CHECK(frames.push(frame_of(1)));
}

TEST_CASE("frames leave at once, but while a value is far away") {
  PlausibleFrames frames(test::made_setup().counts);
  for (int k = 0; k < 100; ++k) {
    CHECK(frames.push(frame_of(k)));
    CHECK(leaving(frames) == Intervals{k});
  }
  Frame wild = frame_of(100);
  wild[SignalKind::kCv].values(0) = 400.0;
  frames.push(wild);
  CHECK(leaving(frames).empty());
  frames.push(frame_of(101));
  CHECK(leaving(frames) == Intervals{100, 101});
}

TEST_CASE("a set-point that is stepped for good is taken from its first sample on") {
  PlausibleFrames frames(test::made_setup().counts);
  Intervals left;
  for (int k = 0; k < 200; ++k) {
    Frame frame = frame_of(k);
    if (k >= 100) frame[SignalKind::kSetpoint].values(0) = 30.0;
    frames.push(frame);
    while (const Frame* out = frames.next()) {
      left.push_back(out->interval);
      CHECK((*out)[SignalKind::kSetpoint].usable(0));
    }
  }
  CHECK(left.size() == 200);
}

TEST_CASE("where a run ends far away, what waits leaves and the far values do not count") {
  PlausibleFrames frames(test::made_setup().counts);
  for (int k = 0; k < 100; ++k) {
    frames.push(frame_of(k));
    leaving(frames);
  }
  for (int k = 100; k < 103; ++k) {
    Frame wild = frame_of(k);
    wild[SignalKind::kMv].values(0) = 400.0;
    frames.push(wild);
    CHECK(leaving(frames).empty());
  }
  frames.end_run();
  CHECK(leaving(frames) == Intervals{100, 101, 102});
  frames.push(frame_of(7));
  CHECK(leaving(frames) == Intervals{7});
}

}  // namespace
}  // namespace mpm
