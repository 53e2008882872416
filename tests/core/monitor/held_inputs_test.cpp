#include "core/monitor/held_inputs.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/model/linear_model.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

// White values of range +-1, held until they have left a deadband.
void push_held(double deadband, Screen& screen) {
  Frame frame(SignalCounts{2, 0, 1, 0});
  double held = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double moved = test::uniform(5, k);
    if (std::abs(moved - held) > deadband) held = moved;
    frame.interval = k;
    const auto set = [&](SignalKind kind, int i, double value) {
      frame[kind].values(i) = value;
      frame[kind].quality[static_cast<std::size_t>(i)] = Quality::kGood;
    };
    set(SignalKind::kMv, 0, held);
    set(SignalKind::kMv, 1, test::uniform(6, k));
    set(SignalKind::kCv, 0, test::uniform(7, k));
    screen.push(frame);
    while (screen.next() != nullptr) {
    }
  }
}

}  // namespace

TEST_CASE("what a deadband took from an input is weighed as the CV sees it") {
  const double time_constant = GENERATE(5.0, 50.0);
  const LinearModel model(test::model_of(
      {test::lag(0, 0, 2.0, time_constant), test::lag(0, 1, 2.0, time_constant)}, 2, 1));
  Screen screen(SignalCounts{2, 0, 1, 0}, Screen::Looks::kAll);
  push_held(0.6, screen);
  const Compression& input = screen.input_compression(0);
  REQUIRE(input.kind() == Compression::Kind::kHeld);
  const HeldInputs held(model);
  // By hand: 2 d sqrt(share / 3 tanh(h / 2T)).
  const double off =
      2.0 * input.smallest_change() *
      std::sqrt(input.held_share() / 3.0 * std::tanh(input.held_for() / (2.0 * time_constant)));
  CHECK(held.heaviest(0, screen, off / 0.3 * 0.99, 0.3) == 0);
  CHECK(held.heaviest(0, screen, off / 0.3 * 1.01, 0.3) == -1);
  CHECK(held.heaviest(0, screen, 0.0, 0.3) == -1);  // of a CV of which no noise is known
}

TEST_CASE("what a deadband took from an input adds up in a channel that integrates") {
  const LinearModel model(
      test::model_of({{0, 0, TransferFunction{0.001, {}, 0.0, 0.0, true}}}, 2, 1));
  Screen screen(SignalCounts{2, 0, 1, 0}, Screen::Looks::kAll);
  push_held(0.6, screen);
  CHECK(HeldInputs(model).heaviest(0, screen, 1e6, 0.3) == 0);
}

}  // namespace mpm
