#include "daemon/live/frame_ring.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/allocation_counter.hpp"
#include "tests/daemon/live/live_frames.hpp"

namespace mpm::live {
namespace {

constexpr SignalCounts kCounts{1, 1, 1, 0};

}  // namespace

TEST_CASE("the ring keeps the last frames in their order") {
  FrameRing ring(kCounts, 4);
  CHECK(ring.copy().rows() == 0);
  for (int k = 1; k <= 3; ++k) ring.push(test::frame_at(k, kCounts));
  CHECK(ring.rows() == 3);
  Recording recording = ring.copy().recording(1.0);
  REQUIRE(recording.samples() == 3);
  CHECK(recording.start_s == 1.0);
  CHECK(recording.cvs(0, 0) == 1.0);

  for (int k = 4; k <= 10; ++k) {
    ring.push(test::frame_at(k, kCounts));
    recording = ring.copy().recording(1.0);
    REQUIRE(recording.samples() == 4);
    for (int row = 0; row < 4; ++row) {
      CHECK(recording.cvs(row, 0) == k - 3 + row);
      CHECK(recording.inputs(row, 0) == 10 * (k - 3 + row));   // MV
      CHECK(recording.inputs(row, 1) == 100 * (k - 3 + row));  // DV
    }
    CHECK(recording.start_s == k - 3);
  }
  CHECK(ring.copy().last_interval == 10);
  CHECK(recording.aux.rows() == 4);
  CHECK(recording.aux.cols() == 0);
}

TEST_CASE("what is missing or bad is a NaN, and a gap has its rows") {
  FrameRing ring(kCounts, 5);
  Frame bad = test::frame_at(1, kCounts);
  bad[SignalKind::kCv].quality[0] = Quality::kBad;
  ring.push(bad);
  ring.push(test::frame_at(4, kCounts));
  ring.push(test::frame_at(3, kCounts));  // too late
  const Recording recording = ring.copy().recording(1.0);
  REQUIRE(recording.samples() == 4);
  CHECK(std::isnan(recording.cvs(0, 0)));
  CHECK(recording.inputs(0, 0) == 10.0);
  CHECK(std::isnan(recording.inputs(1, 1)));
  CHECK(std::isnan(recording.cvs(2, 0)));
  CHECK(recording.cvs(3, 0) == 4.0);

  ring.push(test::frame_at(9, kCounts));  // a gap of all but one row
  CHECK(ring.rows() == 5);
  CHECK(ring.copy().recording(1.0).cvs(0, 0) != 4.0);
  ring.push(test::frame_at(1'000'000'000, kCounts));
  CHECK(ring.rows() == 1);
}

TEST_CASE("a frame allocates nothing") {
  FrameRing ring(kCounts, 3);
  const Frame frame = test::frame_at(1, kCounts);
  const Frame later = test::frame_at(6, kCounts);
  const std::uint64_t before = test::allocation_count();
  ring.push(frame);
  ring.push(later);
  CHECK(test::allocation_count() == before);
}

}  // namespace mpm::live
