#include "core/model/tank_channel.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "core/model/linear_model.hpp"

namespace {

using Eigen::VectorXd;
using mpm::LinearModel;
using mpm::ModelSpec;
using mpm::TankChain;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Operating point u = 40 %, y = 50 %; no flow at u = 10, an empty last tank reads y = 20.
ModelSpec tank_model(const TankChain& tanks, double sample_time_s = 1.0) {
  ModelSpec spec;
  spec.sample_time_s = sample_time_s;
  spec.input_count = 1;
  spec.cv_count = 1;
  spec.input_origin = VectorXd::Constant(1, 40.0);
  spec.output_origin = VectorXd::Constant(1, 50.0);
  spec.channels.push_back({0, 0, tanks});
  return spec;
}

TankChain two_tanks() { return {{20.0, 35.0}, 10.0, 20.0, {kNever, kNever}, 0.0, 0.0}; }

double level_of(const LinearModel& model) { return 1.0 + (model.output()(0) - 50.0) / 30.0; }

/// The equations of `TankChain` by Euler steps of 1/2000 s: another method than the model's.
class EulerTanks {
 public:
  explicit EulerTanks(TankChain tanks)
      : tanks_(std::move(tanks)), levels_(tanks_.time_constants_s.size(), 1.0) {}

  void run(double seconds, const std::function<double(double)>& input_at, double from_s) {
    constexpr double kStep = 1.0 / 2000.0;
    const auto steps = static_cast<int>(std::lround(seconds / kStep));
    for (int i = 0; i < steps; ++i) {
      double flow = std::max(
          0.0, 1.0 + (input_at(from_s + (i + 0.5) * kStep) - 40.0) / (40.0 - tanks_.empty_input));
      for (std::size_t n = 0; n < levels_.size(); ++n) {
        const double out = std::sqrt(levels_[n]);
        const double rate = 2.0 / tanks_.time_constants_s[n];
        double level = std::max(0.0, levels_[n] + kStep * rate * (flow - out));
        double over = 0.0;
        if (level > tanks_.overflow[n]) {
          over = (level - tanks_.overflow[n]) / (kStep * rate);
          level = tanks_.overflow[n];
        }
        levels_[n] = level;
        flow = out + tanks_.spill * over;
      }
    }
  }
  [[nodiscard]] double output() const {
    return 50.0 + (50.0 - tanks_.empty_output) * (levels_.back() - 1.0);
  }

 private:
  TankChain tanks_;
  std::vector<double> levels_;
};

/// Inputs held for a while each, from a closed valve to twice the usual flow.
VectorXd wandering_input(int length) {
  std::mt19937_64 engine(7);
  VectorXd input(length);
  double level = 40.0;
  for (int k = 0; k < length; ++k) {
    if (k % 40 == 0) level = -20.0 + 100.0 * static_cast<double>(engine() >> 11) * 0x1p-53;
    input(k) = level;
  }
  return input;
}

}  // namespace

TEST_CASE("tanks follow a fine integration of their equations") {
  TankChain tanks = two_tanks();
  double tolerance = 0.002;  // Euler's own error at 1/2000 s, in %; the levels span 100 %
  SECTION("without overflow") {}
  SECTION("both overflow, half of it is spilt on") {
    tanks.overflow = {1.8, 1.5};
    tanks.spill = 0.5;
    tolerance = 0.01;  // a step in which a tank begins to overflow
  }
  SECTION("with a fractional dead time") { tanks.dead_time_s = 2.3; }
  SECTION("three, one much faster than the sample time") {
    tanks.time_constants_s = {20.0, 0.05, 35.0};
    tanks.overflow = {1.8, kNever, kNever};
    tolerance = 0.02;
  }
  constexpr int kSamples = 300;
  const VectorXd input = wandering_input(kSamples);
  const auto input_at = [&](double time_s) {
    const double k = std::floor(time_s - tanks.dead_time_s);
    return k < 0.0 ? 40.0 : input(static_cast<Eigen::Index>(k));
  };
  LinearModel model(tank_model(tanks));
  EulerTanks reference(tanks);
  double lowest = 100.0, highest = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    CAPTURE(k);
    REQUIRE(std::abs(model.output()(0) - reference.output()) < tolerance);
    lowest = std::min(lowest, model.output()(0));
    highest = std::max(highest, model.output()(0));
    model.advance(input.segment(k, 1));
    reference.run(1.0, input_at, k);
  }
  CHECK(lowest < 30.0);  // the run shows the curve: the CV is 20 where empty, 50 at rest
  CHECK(highest > 60.0);
}

TEST_CASE("a draining tank is the closed form, runs empty and stays so") {
  // Without inflow (T / 2) dh/dt = -sqrt(h): sqrt(h) = 1 - t / T until t = T.
  const TankChain tank{{25.0}, 10.0, 20.0, {}, 0.0, 0.0};
  for (const double sample_time_s : {0.1, 1.0, 10.0}) {
    LinearModel model(tank_model(tank, sample_time_s));
    const auto samples = static_cast<int>(std::lround(50.0 / sample_time_s));
    for (int k = 0; k <= samples; ++k) {
      const double root = std::max(0.0, 1.0 - k * sample_time_s / 25.0);
      CAPTURE(sample_time_s, k);
      CHECK(std::abs(level_of(model) - root * root) < 2e-5);
      model.advance(VectorXd::Constant(1, k % 2 == 0 ? 10.0 : -30.0));  // closed, more than closed
    }
    CHECK(level_of(model) == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("tanks settle where inflow and outflow agree, and a steady reset is there at once") {
  TankChain tanks = two_tanks();
  SECTION("no overflow: h = inflow^2") {
    for (const double input : {10.0, 25.0, 40.0, 70.0}) {
      LinearModel model(tank_model(tanks));
      model.reset_steady(VectorXd::Constant(1, input));
      const double flow = (input - 10.0) / 30.0;
      CHECK(level_of(model) == Approx(flow * flow).margin(1e-14));
      model.advance(VectorXd::Constant(1, input));
      CHECK(level_of(model) == Approx(flow * flow).margin(1e-13));
    }
  }
  SECTION("overflow: the first tank passes sqrt(1.44) = 1.2 and a quarter of the rest") {
    tanks.overflow = {1.44, kNever};
    tanks.spill = 0.25;
    LinearModel model(tank_model(tanks));
    model.reset_steady(VectorXd::Constant(1, 70.0));  // twice the flow
    CHECK(level_of(model) == Approx(1.4 * 1.4).epsilon(1e-13));
    for (int k = 0; k < 50; ++k) model.advance(VectorXd::Constant(1, 70.0));
    CHECK(level_of(model) == Approx(1.4 * 1.4).epsilon(1e-13));
    model.reset();
    for (int k = 0; k < 2000; ++k) model.advance(VectorXd::Constant(1, 70.0));
    CHECK(level_of(model) == Approx(1.4 * 1.4).epsilon(1e-9));
  }
}

TEST_CASE("small movements of tanks are those of their linearisation") {
  TankChain tanks = two_tanks();
  tanks.dead_time_s = 1.6;
  const mpm::TransferFunction transfer = mpm::linearised(tanks, 40.0, 50.0);
  CHECK(transfer.gain == 2.0);  // 2 (50 - 20) / (40 - 10)
  ModelSpec linear = tank_model(tanks);
  linear.channels[0].dynamics = transfer;
  LinearModel model(tank_model(tanks)), reference(linear);
  CHECK(model.steady_gain() == reference.steady_gain());
  CHECK(model.impulse_response(0, 0, 200) == reference.impulse_response(0, 0, 200));
  CHECK(model.settling_samples() == reference.settling_samples());
  CHECK(model.slowest_time_constant_samples() == 35.0);
  CHECK(model.longest_dead_time_samples() == 1.6);
  // 1e-3 of input: 1e-3 x 2 in the CV, and a second-order part of about 1e-7.
  for (int k = 0; k < 300; ++k) {
    CHECK(std::abs(model.output()(0) - reference.output()(0)) < 3e-7);
    const VectorXd input = VectorXd::Constant(1, 40.0 + (k % 100 < 50 ? 1e-3 : -1e-3));
    model.advance(input);
    reference.advance(input);
  }
}

TEST_CASE("an input that opens the tanks downwards works as well") {
  // A valve that closes with rising input: no flow at 100 %, u0 = 40, gain 2 x 30 / -60 = -1.
  TankChain tanks = two_tanks();
  tanks.empty_input = 100.0;
  LinearModel model(tank_model(tanks));
  CHECK(model.steady_gain()(0, 0) == -1.0);
  model.reset_steady(VectorXd::Constant(1, 70.0));  // half the flow
  CHECK(level_of(model) == Approx(0.25));
}

TEST_CASE("impossible tanks are refused") {
  const auto refused = [](auto change) {
    TankChain tanks = two_tanks();
    change(tanks);
    CHECK_THROWS_AS(LinearModel(tank_model(tanks)), std::invalid_argument);
  };
  refused([](TankChain& t) { t.time_constants_s.clear(); });
  refused([](TankChain& t) { t.time_constants_s[1] = 0.0; });
  refused([](TankChain& t) { t.empty_input = 40.0; });
  refused([](TankChain& t) { t.empty_output = 50.0; });
  refused([](TankChain& t) { t.overflow = {1.5}; });
  refused([](TankChain& t) { t.overflow = {1.5, 1.0}; });
  refused([](TankChain& t) { t.spill = 1.1; });
  refused([](TankChain& t) { t.dead_time_s = -1.0; });
}
