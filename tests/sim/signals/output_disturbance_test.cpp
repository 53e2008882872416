#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/loop/closed_loop.hpp"
#include "sim/signals/output_disturbance.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/sim/units.hpp"

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using mpm::Frame;
using mpm::SignalKind;
using mpm::config::Disturbance;
using mpm::config::DisturbanceKind;
using mpm::config::ScenarioConfig;
using mpm::config::UnitConfig;
using mpm::sim::ClosedLoop;
using mpm::sim::LoopSetup;
using mpm::sim::OutputDisturbance;
using mpm::test::load_plant;

/// v(k), a column per interval.
MatrixXd run(const UnitConfig& unit, const ScenarioConfig& scenario, int samples,
             std::uint64_t seed = 1) {
  OutputDisturbance disturbance(unit, scenario, seed);
  MatrixXd values(static_cast<Index>(unit.cv.size()), samples);
  for (int k = 0; k < samples; ++k) values.col(k) = disturbance.next();
  return values;
}

/// What one disturbance adds to the unit's own noise.
VectorXd added(const Disturbance& disturbance, int samples) {
  const UnitConfig unit = load_plant("shell3x3");
  ScenarioConfig scenario;
  scenario.disturbances = {disturbance};
  const MatrixXd difference = run(unit, scenario, samples) - run(unit, {}, samples);
  CHECK(difference.row(0).isZero(0.0));  // nothing else shifts
  CHECK(difference.row(2).isZero(0.0));
  return difference.row(1);
}

Disturbance on_y2(DisturbanceKind kind, double size) {
  Disturbance disturbance;
  disturbance.kind = kind;
  disturbance.cv = "y2";
  disturbance.size = size;
  return disturbance;
}

double covariance(const VectorXd& late, const VectorXd& early, Index lag) {
  const Index count = late.size() - lag;
  return late.tail(count).dot(early.head(count)) / static_cast<double>(count);
}

/// w(k) = v(k) - pole v(k-1) in units of sigma.
VectorXd innovations(const VectorXd& values) {
  return (values.tail(values.size() - 1) - 0.95 * values.head(values.size() - 1)) / 0.01;
}

}  // namespace

TEST_CASE("steps, ramps and sines are what they say") {
  constexpr double kTight = 1e-12;
  SECTION("step") {
    Disturbance step = on_y2(DisturbanceKind::kStep, 0.4);
    step.from_s = 99.5;  // from the first sample that is not before it
    step.until_s = 200.0;
    const VectorXd values = added(step, 300);
    for (Index k = 0; k < 300; ++k)
      CHECK(values(k) == Approx(k >= 100 && k < 200 ? 0.4 : 0.0).margin(kTight));
  }
  SECTION("lagged step") {
    Disturbance step = on_y2(DisturbanceKind::kStep, 0.4);
    step.from_s = 100.0;
    step.until_s = 400.0;
    step.time_constant_s = 30.0;
    const VectorXd values = added(step, 700);
    // 1 - exp(-(k - 99) / 30) and exp(-(k - 399) / 30): first order, acting within the sample.
    CHECK(values(99) == Approx(0.0).margin(kTight));
    CHECK(values(129) == Approx(0.4 * (1.0 - std::exp(-1.0))).margin(kTight));
    CHECK(values(399) == Approx(0.4 * (1.0 - std::exp(-10.0))).margin(kTight));
    CHECK(values(429) == Approx(0.4 * (1.0 - std::exp(-10.0)) * std::exp(-1.0)).margin(kTight));
  }
  SECTION("ramp") {
    Disturbance ramp = on_y2(DisturbanceKind::kRamp, 0.5);
    ramp.from_s = 100.0;
    ramp.duration_s = 200.0;
    const VectorXd values = added(ramp, 500);
    CHECK(values(100) == Approx(0.0).margin(kTight));
    CHECK(values(200) == Approx(0.25).margin(kTight));
    CHECK(values(300) == Approx(0.5).margin(kTight));
    CHECK(values(499) == Approx(0.5).margin(kTight));
  }
  SECTION("periodic") {
    Disturbance sine = on_y2(DisturbanceKind::kPeriodic, 0.1);
    sine.period_s = 70.0;
    sine.phase_degrees = 90.0;
    const VectorXd values = added(sine, 300);
    for (Index k = 0; k < 300; ++k)
      CHECK(values(k) ==
            Approx(0.1 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / 70.0))
                .margin(kTight));
  }
}

TEST_CASE("sensor noise is white, a drift nearly integrates") {
  constexpr int kCount = 200000;
  const VectorXd white = added(on_y2(DisturbanceKind::kSensorNoise, 0.03), kCount);
  const double variance = covariance(white, white, 0);
  CHECK(variance == Approx(9e-4).epsilon(0.02));  // 4 standard errors: 4 sqrt(2 / n) = 1.3 %
  for (const Index lag : {1, 2, 5})
    CHECK(std::abs(covariance(white, white, lag) / variance) < 4.0 / std::sqrt(kCount));

  const VectorXd drift = added(on_y2(DisturbanceKind::kDrift, 0.01), kCount);
  const VectorXd steps = drift.tail(kCount - 1) - 0.999 * drift.head(kCount - 1);
  CHECK(covariance(steps, steps, 0) == Approx(1e-4).epsilon(0.02));
  CHECK(std::abs(covariance(steps, steps, 1)) < 1e-4 * 4.0 / std::sqrt(kCount));
  // Variance 1e-4 / (1 - .999^2) = 0.05; about n / 2000 = 100 samples' worth, so 4 x 14 %.
  CHECK(covariance(drift, drift, 0) == Approx(0.05).epsilon(0.56));
}

TEST_CASE("coupled noise arrives at the second CV after its lag") {
  UnitConfig unit = load_plant("shell3x3");
  for (auto& noise : unit.simulation.noise)
    noise.pole = 0.0;  // white: covariances are single peaks
  ScenarioConfig scenario;
  mpm::config::NoiseChange coupling;
  coupling.cv = "y2";
  coupling.follows = "y1";
  coupling.lag_samples = 5;
  coupling.gain = 0.8;
  scenario.noise = {coupling};
  constexpr int kCount = 100000;
  const MatrixXd values = run(unit, scenario, kCount);
  const VectorXd leader = values.row(0), follower = values.row(1), other = values.row(2);
  const double error = 4.0 * 1e-4 * std::sqrt(1.0 + 0.64) / std::sqrt(kCount);
  for (Index lag = 0; lag <= 10; ++lag) {
    CAPTURE(lag);
    const double expected = lag == 5 ? 0.8 * 1e-4 : 0.0;
    CHECK(covariance(follower, leader, lag) == Approx(expected).margin(2.0 * error));
    CHECK(covariance(other, leader, lag) == Approx(0.0).margin(error));
    CHECK(covariance(leader, follower, lag) == Approx(0.0).margin(error));
  }
  CHECK(covariance(follower, follower, 0) == Approx(1e-4 * 1.64).epsilon(0.03));
  // The leader and the third CV have the numbers that they have without it.
  const MatrixXd plain = run(unit, {}, kCount);
  CHECK(values.row(0) == plain.row(0));
  CHECK(values.row(2) == plain.row(2));
}

TEST_CASE("heavy tails have the tail of Student's t and the sigma of the unit file") {
  const UnitConfig unit = load_plant("shell3x3");
  constexpr int kCount = 400000;
  const auto tails = [&](double freedom) {
    ScenarioConfig scenario;
    mpm::config::NoiseChange change;
    change.cv = "y2";
    change.student_t = freedom;
    scenario.noise = {change};
    const MatrixXd values = run(unit, scenario, kCount);
    CHECK(values.row(0) == run(unit, {}, kCount).row(0));
    return innovations(values.row(1));
  };
  SECTION("ten degrees of freedom: all moments that matter exist") {
    const VectorXd w = tails(10.0);
    const double variance = w.squaredNorm() / static_cast<double>(w.size());
    const double fourth = w.array().pow(4).mean();
    CHECK(variance == Approx(1.0).epsilon(0.02));
    // Kurtosis 3 + 6 / (f - 4) = 4; its estimate converges slowly.
    CHECK(fourth / (variance * variance) == Approx(4.0).epsilon(0.1));
  }
  SECTION("2.5 degrees of freedom: quantiles, since the fourth moment does not exist") {
    const VectorXd w = tails(2.5) / std::sqrt(0.5 / 2.5);
    // P(|t| > x) for 2.5 degrees of freedom by numerical integration of the density:
    // 0.404061 at 1, 0.039013 at 4, 0.004441 at 10. Five standard errors at most.
    const auto share = [&](double limit) {
      return (w.array().abs() > limit).cast<double>().mean();
    };
    CHECK(share(1.0) == Approx(0.404061).epsilon(0.01));
    CHECK(share(4.0) == Approx(0.039013).epsilon(0.04));
    CHECK(share(10.0) == Approx(0.004441).epsilon(0.11));
  }
}

TEST_CASE("noise goes back to normal at its end") {
  const UnitConfig unit = load_plant("shell3x3");
  ScenarioConfig scenario;
  mpm::config::NoiseChange change;
  change.sigma_ratio = 3.0;
  change.from_s = 1000.0;
  change.until_s = 2000.0;
  scenario.noise = {change};
  const MatrixXd changed = run(unit, scenario, 3000), plain = run(unit, {}, 3000);
  const VectorXd w = innovations(changed.row(2)), same = innovations(plain.row(2));
  for (Index k = 0; k + 1 < 3000; ++k)
    CHECK(w(k) == Approx(same(k) * (k + 1 >= 1000 && k + 1 < 2000 ? 3.0 : 1.0)).margin(1e-10));
}

TEST_CASE("equal set-points move as one, others not at all") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("shell3x3"));
  setup.unit.simulation.setpoints[1].amplitude = 1.0;
  ClosedLoop plain(setup);
  SECTION("equal") {
    setup.scenario.equal_setpoints = {"y1", "y2"};
    ClosedLoop loop(setup);
    for (int k = 0; k < 2000; ++k) {
      const VectorXd usual = plain.step()[SignalKind::kSetpoint].values;
      const VectorXd& now = loop.step()[SignalKind::kSetpoint].values;
      REQUIRE(now(0) == usual(0));
      REQUIRE(now(1) == 2.0 * usual(0));  // in shares of the amplitudes
      REQUIRE(now(2) == usual(2));
    }
  }
  SECTION("moving") {
    setup.scenario.moving_setpoints = {{"y3"}};
    ClosedLoop loop(setup);
    for (int k = 0; k < 2000; ++k) {
      const VectorXd usual = plain.step()[SignalKind::kSetpoint].values;
      const VectorXd& now = loop.step()[SignalKind::kSetpoint].values;
      REQUIRE(now(0) == 0.0);
      REQUIRE(now(1) == 0.0);
      REQUIRE(now(2) == usual(2));
    }
  }
}

TEST_CASE("a controller that is off holds the MVs and goes on predicting") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("wood_berry"));
  setup.scenario.controller_off = {{60.0 * 500, 60.0 * 800}};
  ClosedLoop loop(setup);
  mpm::LinearModel model(setup.unit.model);
  VectorXd input(3), held;
  double largest_move_after = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const Frame& frame = loop.step();
    REQUIRE(frame[SignalKind::kPrediction].values == model.output());
    const VectorXd& moved = frame[SignalKind::kMv].values;
    if (k == 499) held = moved;
    if (k >= 500 && k < 800) REQUIRE(moved == held);
    if (k == 800) largest_move_after = (moved - held).cwiseAbs().maxCoeff();
    input << moved, frame[SignalKind::kDv].values;
    model.advance(input);
  }
  CHECK(largest_move_after > 0.0);
  CHECK(largest_move_after <= 0.2);  // max_move of both MVs
  CHECK(loop.finite());
}

TEST_CASE("tight limits hold an MV for much of the run") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("shell3x3"));
  mpm::config::MvLimitChange change;
  change.mv = "u1";
  change.ratio = 0.12;
  setup.scenario.mv_limits = {change};
  ClosedLoop loop(setup);
  int at_limit = 0;
  double largest = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double value = std::abs(loop.step()[SignalKind::kMv].values(0));
    largest = std::max(largest, value);
    if (value > 0.6 - 1e-9) ++at_limit;
  }
  CHECK(largest == Approx(0.6));
  CHECK(at_limit > 600);
  change.low = 3.0;
  setup.scenario.mv_limits = {change};
  CHECK_THROWS_WITH(ClosedLoop(setup), Catch::Matchers::Contains("u1"));
}

TEST_CASE("a step with every disturbance does not allocate") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("shell3x3"));
  for (const DisturbanceKind kind :
       {DisturbanceKind::kStep, DisturbanceKind::kRamp, DisturbanceKind::kDrift,
        DisturbanceKind::kPeriodic, DisturbanceKind::kSensorNoise}) {
    setup.scenario.disturbances.push_back(on_y2(kind, 0.02));
    setup.scenario.disturbances.back().period_s = 70.0;
    setup.scenario.disturbances.back().duration_s = 70.0;
  }
  mpm::config::NoiseChange change;
  change.cv = "y2";
  change.sigma_ratio = 2.0;
  change.student_t = 2.5;
  change.follows = "y1";
  change.lag_samples = 5;
  setup.scenario.noise = {change};
  setup.scenario.controller_off = {{100.0, 200.0}};
  ClosedLoop loop(setup);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 500; ++k) static_cast<void>(loop.step());
  CHECK(mpm::test::allocation_count() == before);
}
