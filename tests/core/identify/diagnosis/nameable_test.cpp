#include "core/identify/diagnosis/nameable.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/fit/quantity.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::nameable_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 1500;

/// An MV and a DV act on one CV, one of them with a gain that is `off`; the second CV, which the DV
/// moves too, is as the model says.
struct Bench {
  double off = 1.0, noise = 0.1;
  Index wrong = 0;  ///< the input: the MV, with a gain of 2, or the DV, with 1
  ModelSpec model =
      test::model_of({lag(0, 0, 2.0, 10.0), lag(0, 1, 1.0, 5.0), lag(1, 1, 1.0, 8.0)}, 2, 2);
  ChannelTests tests = make();
  std::vector<std::optional<double>> shares{1.0, 1.0};
  std::function<bool(const Effect&)> may = nameable(model, {1, 2, 0}, tests, tests, shares);

  ChannelTests make() const {
    MatrixXd u(kRows, 2), residuals(kRows, 2);
    u << test::telegraph(1, kRows, 12), test::telegraph(2, kRows, 9);
    residuals << test::first_order(u.col(wrong), off, 10.0) + noise * test::white(3, kRows),
        noise * test::white(4, kRows);
    Recording recording = test::recording_of(u, residuals);
    recording.setpoints.resize(kRows, 2);
    recording.setpoints << test::telegraph(5, kRows, 40), test::telegraph(6, kRows, 50);
    return {model, recording, residuals};
  }
  [[nodiscard]] bool operator()(const Cause& cause, const Place& place) const {
    Effect effect;
    effect.edit = &cause;
    effect.place = place;
    return may(effect);
  }
};

// A square about the middle of three levels: next to nothing of it is linear.
TEST_CASE("a curve may be named where the nonlinear test sees it, moved by feedback or not") {
  constexpr Index kMany = 3000;
  MatrixXd u(kMany, 2), residuals(kMany, 2);
  u << test::telegraph(1, kMany, 12) + test::telegraph(7, kMany, 17), test::telegraph(2, kMany, 9);
  const VectorXd square = u.col(0).array().square() - u.col(0).array().square().mean();
  residuals << 0.5 * test::first_order(square, 1.0, 10.0) + 0.1 * test::white(3, kMany),
      0.1 * test::white(4, kMany);
  const Bench bench;
  const Recording recording = test::recording_of(u, residuals);
  const ChannelTests linear(bench.model, recording, residuals);
  const ChannelTests nonlinear(bench.model, recording, residuals, OwnPast::kAsMonitor);
  const std::vector<std::optional<double>> by_feedback{0.1, 0.1};
  const auto may = [&](const ChannelTests& asked, const Cause& cause, const Place& place) {
    Effect effect;
    effect.edit = &cause;
    effect.place = place;
    return nameable(bench.model, {1, 2, 0}, linear, asked, by_feedback)(effect);
  };
  CHECK(nonlinear.bends({{0, 0}}));
  CHECK_FALSE(nonlinear.bends({{0, 1}}));
  CHECK_FALSE(nonlinear.bends({{1, 1}}));
  CHECK_FALSE(linear.bends({{0, 0}}));
  CHECK(may(nonlinear, causes::input_polynomial(), {0, 0}));
  CHECK_FALSE(may(linear, causes::input_polynomial(), {0, 0}));
  CHECK_FALSE(may(nonlinear, causes::input_polynomial(), {0, 1}));
}

TEST_CASE("no level is named of a CV of which a channel is off") {
  const Bench bench;
  CHECK_FALSE(bench.may(causes::constant_offset(0, 3.0, 0.1)));
  CHECK(bench.may(causes::constant_offset(1, 3.0, 0.1)));
  Effect later = causes::constant_offset(0, 3.0, 0.1);
  later.onset = 500;
  CHECK(bench.may(later));
}

TEST_CASE("a channel may be named where the test rejects it") {
  const Bench bench;
  CHECK(bench(causes::gain(), {0, 0}));
  CHECK_FALSE(bench(causes::gain(), {0, 1}));
  CHECK_FALSE(bench(causes::gain(), {1, 1}));
}

TEST_CASE("a scale may be named where the test rejects one of its channels") {
  const Bench bench;
  CHECK(bench(causes::input_scale(), {-1, 0}));
  CHECK_FALSE(bench(causes::input_scale(), {-1, 1}));
  CHECK(bench(causes::output_scale(), {0}));
  CHECK_FALSE(bench(causes::output_scale(), {1}));
}

TEST_CASE("a CV's own set-point may be named where no wrong channel says as much") {
  const Bench bench;  // no aux signals: the first behind them is the first CV's set-point
  CHECK_FALSE(bench(causes::unmodelled_input(), {0, -1, 0}));
  CHECK(bench(causes::unmodelled_input(), {0, -1, 1}));
  CHECK(bench(causes::unmodelled_input(), {1, -1, 1}));
}

TEST_CASE("a disturbance needs no test, and a DV has no actuator") {
  const Bench bench;
  CHECK(bench(causes::step_disturbance(), {1}));
  CHECK(bench(causes::input_offset(), {-1, 0}));
  CHECK_FALSE(bench(causes::input_offset(), {-1, 1}));
  CHECK_FALSE(bench(causes::input_stuck(), {-1, 1}));
}

TEST_CASE("a curve may be named where the test rejects and not all movement is feedback") {
  Bench bench;
  CHECK(bench(causes::input_polynomial(), {0, 0}));
  CHECK_FALSE(bench(causes::input_polynomial(), {0, 1}));
  bench.shares[0] = 0.1;
  for (const Cause* curve : {&causes::input_polynomial(), &causes::input_saturation(),
                             &causes::cubic_stiffness(), &causes::square_root_outflow()})
    CHECK_FALSE(bench(*curve, {0, 0}));
  CHECK(bench(causes::gain(), {0, 0}));
  CHECK(bench(causes::stiction(), {-1, 0}));
  bench.shares[0] = std::nullopt;  // nobody knows
  CHECK(bench(causes::input_polynomial(), {0, 0}));
}

// Named for all CVs of the input it would bend what is straight, and hide what else is wrong there.
TEST_CASE("where a curve of an input may be named, one of any of its channels may") {
  const Bench bench{.wrong = 1};
  CHECK(bench(causes::input_polynomial(), {-1, 1}));
  CHECK(bench(causes::input_polynomial(), {0, 1}));
  CHECK(bench(causes::input_polynomial(), {1, 1}));
  CHECK_FALSE(bench(causes::gain(), {1, 1}));
  CHECK_FALSE(bench(causes::input_polynomial(), {0, 0}));
}

// Of a CV that a controller holds a model without the channel explains all that the loop shows.
TEST_CASE("where nothing but feedback moves an input no gain or lag of it is named") {
  Bench bench;
  bench.shares[0] = 0.04;
  CHECK_FALSE(bench(causes::gain(), {0, 0}));
  CHECK_FALSE(bench(causes::dead_time(), {0, 0}));
  CHECK_FALSE(bench(causes::input_scale(), {-1, 0}));
  CHECK(bench(causes::output_scale(), {0}));  // by the DV
  bench.shares[1] = 0.04;
  CHECK_FALSE(bench(causes::output_scale(), {0}));
  CHECK(bench(causes::stiction(), {-1, 0}));
  CHECK(bench(causes::input_stuck(), {-1, 0}));
  Effect step = causes::constant_offset(0, 3.0, 0.1);
  step.onset = 100;
  CHECK(bench.may(step));
  bench.shares[0] = std::nullopt;  // nobody knows
  CHECK(bench(causes::gain(), {0, 0}));
}

// In a free run errors that matter in no channel may add up to what looks like a large one of all.
TEST_CASE("what is off by too little to matter names no curve and no scale, however surely seen") {
  const Bench bench{.off = 0.03, .noise = 0.01};  // 1.5 %
  REQUIRE(bench.tests.reject({{0, 0}}, 1e-6));
  CHECK_FALSE(bench(causes::input_polynomial(), {0, 0}));
  Effect scale;
  scale.edit = &causes::output_scale();
  scale.place = {0};
  Coordinate ratio;
  ratio.quantity = &kGainRatio;
  scale.coordinates = {ratio};
  CHECK_FALSE(bench.may(scale));
  CHECK(Bench().may(scale));
  scale.edit = &causes::stiction();  // with a gain of its own
  scale.place = {-1, 0};
  CHECK(bench.may(scale));
}

// Else another cause would be named for what it does.
TEST_CASE("an error of a channel is taken in however small it is") {
  const Bench bench{.off = 0.03, .noise = 0.01};
  CHECK(bench(causes::gain(), {0, 0}));
  CHECK(bench(causes::dead_time(), {0, 0}));
}

}  // namespace
}  // namespace mpm::nameable_test
