#include "core/mismatch/outside_signals.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/mismatch/mismatch_detector.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::outside_signals_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One input to one CV; set-points and an auxiliary signal move by themselves, the input follows the
// first one and a dither of its own.
struct Loop {
  RegressionShape shape{1, 1, 8, 2, {std::exp(-1.0 / 20.0)}};
  ModelSpec spec;
  MismatchDetector detector;
  OutsideSignals outside;

  Loop()
      : spec(test::channel_model(1, 1, {{0, 0, TransferFunction{2.0, {20.0}, 0, 2, false}}})),
        detector(shape, {{0.999, 0}}, 1500, 10, LinearModel(spec)),
        outside(shape, 2, {std::exp(-1.0 / 20.0), std::exp(-1.0 / 7.0)}, 1500) {}

  // `of_input`: gain error, relative; `of_signal`: what a lag of 10 samples of signal 1 adds.
  RivalSignal run(double of_input, double of_signal) {
    LinearModel model(spec);
    Eigen::VectorXd u(1), e(1), signals(2);
    double noise = 0.0, lag = 0.0;
    for (int k = 0; k < 2000; ++k) {
      signals(0) = test::uniform(1, k / 60) > 0.0 ? 1.0 : -1.0;
      signals(1) = test::uniform(2, k / 45);
      u(0) = 0.7 * signals(1) + 0.3 * signals(0) + 0.2 * test::uniform(3, k / 10);
      noise = 0.6 * noise + 0.1 * test::uniform(4, k);
      e(0) = noise + of_input * model.output()(0) + of_signal * lag;
      detector.update(u, e);
      if (k % 97 == 0) signals(0) = kNan;  // unknown: as it was
      outside.push(signals);
      model.advance(u);
      lag += 0.1 * (signals(1) - lag);
    }
    detector.evaluate(0);
    // The first time it is asked what only reads an input back.
    const auto ask = [this] {
      return outside.followed(0, detector.history(), detector.regression(0),
                              detector.usual_errors(0));
    };
    static_cast<void>(ask());
    const std::uint64_t before = test::allocation_count();
    const FollowedSignal followed = ask();
    CHECK(test::allocation_count() == before);
    return detector.rival(0, followed);
  }
};

TEST_CASE("what a signal adds to a CV is told from an error of the input that moves with it") {
  // Expected: the one that was put in.
  const RivalSignal signal = Loop().run(0.0, 0.5);
  CHECK(signal.wins);
  CHECK(signal.signal == 1);
  const RivalSignal input = Loop().run(0.3, 0.0);
  CHECK_FALSE(input.wins);
  CHECK(input.loses);
}

// The input's error explains more of the residual than the signal does, but not what the signal
// adds, by a test of 0.1 %.
TEST_CASE("a signal that adds something beside an error of the input that moves with it is told") {
  const RivalSignal both = Loop().run(0.3, 0.3);
  CHECK(both.signal == 1);
  CHECK_FALSE(both.wins);
  CHECK_FALSE(both.loses);
}

TEST_CASE("a signal that never moves explains nothing") {
  Loop loop;
  Eigen::VectorXd u(1), e(1);
  for (int k = 0; k < 600; ++k) {
    u(0) = test::uniform(3, k / 10);
    e(0) = test::uniform(4, k);
    loop.detector.update(u, e);
    loop.outside.push(Eigen::Vector2d(5.0, kNan));
  }
  loop.detector.evaluate(0);
  const FollowedSignal followed = loop.outside.followed(
      0, loop.detector.history(), loop.detector.regression(0), loop.detector.usual_errors(0));
  CHECK(followed.signal == -1);
  CHECK(followed.explained == 0.0);
}

}  // namespace
}  // namespace mpm::outside_signals_test
