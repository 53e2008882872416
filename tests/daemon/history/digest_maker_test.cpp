#include "daemon/history/digest_maker.hpp"

#include <catch2/catch.hpp>
#include <deque>

#include "core/signal/screen.hpp"
#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {
namespace {

/// Frames that leave the screen before the thirtieth says what is plausible in them.
constexpr int kEarly = calibration::extent::kFirstValues - 1 - Screen::kDelay;

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST_CASE(
    "a digest is of a quarter of an hour where a sample is a minute, of a minute of seconds") {
  config::UnitConfig unit = test::minute_unit();
  CHECK(DigestMaker(unit).head(0).digest_s == 900.0);
  unit.sample_time_s = unit.model.sample_time_s = 30.0;
  CHECK(DigestMaker(unit).head(0).digest_s == 300.0);
  unit.sample_time_s = unit.model.sample_time_s = 1.0;
  CHECK(DigestMaker(unit).head(0).digest_s == 60.0);
}

// The residual is put into the frames, so that its mean squares are known without the monitor.
TEST_CASE("digests have the mean squares of residuals, moves and measurements") {
  const config::UnitConfig unit = test::minute_unit();
  report::UnitMonitor monitor(unit);
  DigestMaker maker(unit);
  const UnitHead head = maker.head(7);
  CHECK(head.time_ns == 7);
  CHECK(head.channels.at(0).modelled);
  CHECK(head.channels.at(0).gain_limit == 0.05);
  const auto horizon = static_cast<std::size_t>(head.horizon_samples);
  // Five time constants of ten samples settle the model to 1 %; half of that.
  CHECK(std::abs(head.horizon_samples - 25) <= 2);

  test::MinuteFrames frames;
  std::vector<double> residuals, measured;
  std::vector<Digest> digests;
  for (int k = 0; k < 600; ++k) {
    const Frame& frame = frames.next();
    measured.push_back(frame[SignalKind::kCv].values(0));
    residuals.push_back(measured.back() - frame[SignalKind::kPrediction].values(0));
    monitor.push(frame);
    if (auto digest = maker.push(monitor)) digests.push_back(std::move(*digest));
  }
  REQUIRE(digests.size() == 39);
  CHECK(digests[0].from_ns == test::kMonday);
  CHECK(digests[0].until_ns == test::kMonday + 14 * 60 * test::kSecond);
  const std::size_t d = 20;
  std::vector<double> e, moved, went;
  for (std::size_t k = 15 * d; k < 15 * d + 15; ++k) {
    const std::size_t judged = k - Screen::kDelay;
    e.push_back(residuals[judged]);
    moved.push_back(residuals[judged] - residuals[judged - horizon]);
    went.push_back(measured[judged] - measured[judged - horizon]);
  }
  const CvDigest& cv = digests[d].cvs.at(0);
  CHECK(cv.samples == 15);
  CHECK(cv.pairs == 15);
  CHECK(cv.residual_rms == Approx(rms(e)).epsilon(1e-5));
  CHECK(cv.prediction_rms == Approx(rms(moved)).epsilon(1e-5));
  CHECK(cv.movement_rms == Approx(rms(went)).epsilon(1e-5));
  CHECK(digests[0].cvs[0].samples == 0);
  CHECK(digests[1].cvs[0].samples == 30 - Screen::kDelay - kEarly);
  CHECK(digests[0].cvs[0].pairs == 0);
  CHECK_FALSE(known(digests[0].cvs[0].prediction_rms));

  const std::optional<Digest> rest = maker.finish();
  REQUIRE(rest);
  CHECK(rest->samples == 15);
  CHECK_FALSE(maker.finish());
}

TEST_CASE("digests count verdicts, and tell the gain only where it is known") {
  const config::UnitConfig unit = test::minute_unit();
  report::UnitMonitor monitor(unit);
  DigestMaker maker(unit);
  test::MinuteFrames frames(1.3);
  std::vector<Digest> digests;
  std::int64_t mismatches = 0;
  for (int k = 0; k < 3000; ++k) {
    monitor.push(frames.next());
    if (auto digest = maker.push(monitor)) digests.push_back(std::move(*digest));
    if (k < 2985 && monitor.channels()[0].verdict == Verdict::kMismatch) ++mismatches;
  }
  const ChannelDigest& first = digests.front().channels.at(0);
  CHECK(first.match + first.mismatch == 0);
  CHECK(first.reason == "warming_up");
  CHECK_FALSE(known(first.gain_error));
  const ChannelDigest& last = digests.back().channels.at(0);
  CHECK(last.mismatch == 15);
  CHECK(last.alarm == "active");
  CHECK(last.low < 30.0);  // the plant has 1.3 times the gain
  CHECK(last.high > 30.0);
  std::int64_t counted = 0;
  for (const Digest& digest : digests) counted += digest.channels[0].mismatch;
  CHECK(counted == mismatches);
}

// What lies before a gap is no pair of what lies behind it by as many samples.
TEST_CASE("over a gap the horizon is counted in intervals") {
  const config::UnitConfig unit = test::minute_unit();
  report::UnitMonitor monitor(unit);
  DigestMaker maker(unit);
  const auto horizon = static_cast<int>(maker.head(0).horizon_samples);
  test::MinuteFrames frames;
  std::int64_t pairs = 0;
  for (int k = 0; k < 100 + 10 * horizon; ++k) {
    const Frame& frame = frames.next();
    if (k >= 100 && k < 100 + 9 * horizon) continue;  // not seen
    monitor.push(frame);
    if (const auto digest = maker.push(monitor)) pairs += digest->cvs[0].pairs;
  }
  if (const auto digest = maker.finish()) pairs += digest->cvs[0].pairs;
  CHECK(pairs == 100 - kEarly - horizon);  // all before it, none behind it
}

// A sensor that has just been switched on: nobody knows yet what its signal usually is.
TEST_CASE("a wild value among a signal's first is in no digest") {
  const config::UnitConfig unit = test::minute_unit();
  for (const SignalKind kind : {SignalKind::kCv, SignalKind::kPrediction}) {
    report::UnitMonitor monitor(unit);
    DigestMaker maker(unit);
    test::MinuteFrames frames;
    int told = 0;
    for (int k = 0; k < 200; ++k) {
      Frame frame = frames.next();
      if (k == 12) frame[kind].values(0) = 1e20;
      monitor.push(frame);
      const auto digest = maker.push(monitor);
      if (!digest) continue;
      const CvDigest& cv = digest->cvs.at(0);
      CHECK_FALSE(cv.residual_rms > 100.0);
      CHECK_FALSE(cv.prediction_rms > 100.0);
      told += cv.prediction_rms > 0.0 ? 1 : 0;
    }
    CHECK(told > 5);
  }
}

}  // namespace
}  // namespace mpm::history
