#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/model/linear_model.hpp"
#include "core/model/state_feedback.hpp"

namespace {

using Eigen::VectorXd;
using mpm::CoulombFriction;
using mpm::LinearModel;
using mpm::ModelSpec;
using mpm::RestoringForce;
using mpm::SquareRootOutflow;
using mpm::StateBlock;
using mpm::TransferFunction;

/// One lag of gain 2 and 10 s at 1 s around u0 = 5, y0 = 30, with a term.
ModelSpec with_term(const StateBlock& block) {
  ModelSpec spec;
  spec.input_count = 1;
  spec.cv_count = 1;
  spec.input_origin = VectorXd::Constant(1, 5.0);
  spec.output_origin = VectorXd::Constant(1, 30.0);
  spec.channels.push_back({0, 0, TransferFunction{2.0, {10.0}, 0.0, 0.0, false}});
  spec.state_terms.push_back({0, 0, block});
  return spec;
}

VectorXd random_input(int length) {
  std::mt19937_64 engine(11);
  VectorXd input(length);
  double level = 0.0;
  for (int k = 0; k < length; ++k) {
    if (k % 7 == 0) level = 6.0 * (static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5);
    input(k) = level;
  }
  return input;
}

/// phi as model_spec.hpp says it.
double square_root_outflow(double y) { return (40.0 * (std::sqrt((20.0 + y) / 20.0) - 1) - y) / 2; }

}  // namespace

TEST_CASE("a fed back output follows the recursion of its channel") {
  constexpr int kSamples = 400;
  const VectorXd input = random_input(kSamples);
  const double a = std::exp(-0.1);
  const auto run = [&](const ModelSpec& spec, auto&& expected) {
    LinearModel model(spec);
    for (int k = 0; k < kSamples; ++k) {
      CAPTURE(k);
      REQUIRE(model.output()(0) - 30.0 == Approx(expected(k)).margin(1e-12));
      model.advance(VectorXd::Constant(1, 5.0 + input(k)));
    }
  };
  // y(k+1) = a y(k) + 2 (1 - a) (u(k - delay) - phi(y(k - delay))), y(k) for k < 0 at rest.
  const auto recursion = [&](int delay, auto&& phi) {
    std::vector<double> y(kSamples + 1, 0.0);
    for (int k = 0; k < kSamples; ++k) {
      double inflow = 0.0;
      if (k >= delay) {
        const auto at = static_cast<std::size_t>(k - delay);
        inflow = input(k - delay) - phi(y[at], at > 0 ? y[at - 1] : 0.0);
      }
      y[static_cast<std::size_t>(k) + 1] =
          a * y[static_cast<std::size_t>(k)] + 2.0 * (1.0 - a) * inflow;
    }
    return y;
  };
  const auto square_root = [](double y, double) { return square_root_outflow(y); };
  const auto restoring = [](double y, double) { return 0.05 * y * y + 0.02 * y * y * y; };
  const auto friction = [](double y, double before) {
    return 0.4 * std::tanh((y - before) / 0.02);
  };
  SECTION("square root outflow through a lag") {
    const auto y = recursion(0, square_root);
    run(with_term(SquareRootOutflow{10.0}), [&](int k) { return y[static_cast<std::size_t>(k)]; });
  }
  SECTION("through a lag with dead time") {
    ModelSpec spec = with_term(SquareRootOutflow{10.0});
    std::get<TransferFunction>(spec.channels[0].dynamics).dead_time_s = 3.0;
    const auto y = recursion(3, square_root);
    run(spec, [&](int k) { return y[static_cast<std::size_t>(k)]; });
  }
  SECTION("a restoring force through a filter") {
    ModelSpec spec = with_term(RestoringForce{0.05, 0.02});
    spec.channels[0].dynamics = mpm::DiscreteFilter{{2.0 * (1.0 - a)}, {1.0, -a}, 2};
    const auto y = recursion(2, restoring);
    run(spec, [&](int k) { return y[static_cast<std::size_t>(k)]; });
  }
  SECTION("friction through a lag") {
    const auto y = recursion(0, friction);
    run(with_term(CoulombFriction{0.4, 0.02}),
        [&](int k) { return y[static_cast<std::size_t>(k)]; });
  }
  SECTION("a restoring force through a step response") {
    ModelSpec spec = with_term(RestoringForce{0.0, 0.02});
    mpm::StepResponse response;
    for (int k = 0; k < 400; ++k) response.values.push_back(2.0 * (1.0 - std::pow(a, k)));
    spec.channels[0].dynamics = response;
    const auto y = recursion(0, [](double x, double) { return 0.02 * x * x * x; });
    run(spec, [&](int k) { return y[static_cast<std::size_t>(k)]; });
  }
}

TEST_CASE("only the channel that has the term sees it") {
  ModelSpec spec = with_term(RestoringForce{0.0, 0.5});
  spec.cv_count = 2;
  spec.output_origin = VectorXd::Constant(2, 30.0);
  spec.channels.push_back({1, 0, spec.channels[0].dynamics});
  ModelSpec plain = spec;
  plain.state_terms.clear();
  LinearModel model(spec), reference(plain);
  for (int k = 0; k < 50; ++k) {
    model.advance(VectorXd::Constant(1, 8.0));
    reference.advance(VectorXd::Constant(1, 8.0));
  }
  CHECK(model.output()(1) == reference.output()(1));
  CHECK(model.output()(0) < reference.output()(0) - 1.0);
  CHECK(model.steady_gain() == reference.steady_gain());
  CHECK(model.impulse_response(0, 0, 50) == reference.impulse_response(0, 0, 50));
  CHECK(model.settling_samples() == reference.settling_samples());
}

TEST_CASE("a term's rest is where the channel stays") {
  const auto rest_of = [](const StateBlock& block, double deviation) {
    LinearModel model(with_term(block));
    const VectorXd input = VectorXd::Constant(1, 5.0 + deviation);
    model.reset_steady(input);
    const double rest = model.output()(0) - 30.0;
    for (int k = 0; k < 20; ++k) model.advance(input);
    CHECK(model.output()(0) - 30.0 == Approx(rest).margin(1e-11));
    return rest;
  };
  // Y (sqrt(h) - 1) x 2 = K u: h = (1 + 2 u / 40)^2 with Y = 20; u = 4 gives 1.44.
  CHECK(rest_of(SquareRootOutflow{10.0}, 4.0) == Approx(20.0 * 0.44));
  CHECK(rest_of(SquareRootOutflow{10.0}, -10.0) == Approx(20.0 * -0.75));
  CHECK(rest_of(SquareRootOutflow{50.0}, 4.0) == Approx(-20.0 * (0.64 - 1.0)));  // Y = -20
  // y + 2 (0.5 y^3) = 2 u: y = 1 at u = 1, y = -2 at u = -5.
  CHECK(rest_of(RestoringForce{0.0, 0.5}, 1.0) == Approx(1.0));
  CHECK(rest_of(RestoringForce{0.0, 0.5}, -5.0) == Approx(-2.0));
  // y + 2 (0.25 y^2 + 0.5 y^3) = 2 u: y = 1 at 1.25.
  CHECK(rest_of(RestoringForce{0.25, 0.5}, 1.25) == Approx(1.0));
  // y - 0.5 y^2 = 2 u has the roots 1 -+ sqrt(1 - 4 u): the nearer one.
  CHECK(rest_of(RestoringForce{-0.25, 0.0}, 0.1875) == Approx(0.5));
  CHECK(rest_of(CoulombFriction{3.0, 0.1}, 1.0) == Approx(2.0));
  CHECK(rest_of(RestoringForce{0.0, 0.0}, 1.5) == Approx(3.0));
}

TEST_CASE("where nothing holds the channel, its rest is where it begins to run away") {
  const mpm::ChannelFacts facts{true, false, false, 2.0, 10.0, 0.0, 1};
  // y - 0.5 y^2 turns at y = 1, where it is 0.5 = 2 u: u = 0.25.
  const mpm::StateFeedback feedback(RestoringForce{-0.25, 0.0}, facts, 0.0, 1.0);
  CHECK(feedback.rest(0.2499) == Approx(1.0).epsilon(0.03));
  CHECK(feedback.rest(0.3) == 1.0);
  CHECK(feedback.rest(1e300) == 1.0);
  CHECK(feedback.rest(-6.0) == Approx(-4.0));  // y - 0.5 y^2 = -12
}

TEST_CASE("a restoring force that hardly bends keeps the digits of its rest") {
  const mpm::ChannelFacts facts{true, false, false, 1.0, 10.0, 0.0, 1};
  for (const double cubic : {1e-12, -1e-12, 1e-3, 1e6}) {
    for (const double quadratic : {0.0, 1e-9, -1e-9}) {
      const mpm::StateFeedback feedback(RestoringForce{quadratic, cubic}, facts, 0.0, 1.0);
      for (const double input : {1e-6, 0.5, -0.5, 10.0}) {
        const double y = feedback.rest(input);
        CAPTURE(cubic, quadratic, input);
        CHECK(y + feedback.value(y, y) == Approx(input).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("impossible terms are refused") {
  const auto refused = [](auto change) {
    ModelSpec spec = with_term(SquareRootOutflow{10.0});
    change(spec);
    CHECK_THROWS_AS(LinearModel(spec), std::invalid_argument);
  };
  const auto block = [](const StateBlock& b) {
    return [b](ModelSpec& spec) { spec.state_terms[0].block = b; };
  };
  refused(block(SquareRootOutflow{30.0}));  // empty at the operating point
  refused(block(RestoringForce{std::nan(""), 0.0}));
  refused(block(CoulombFriction{-1.0, 1.0}));
  refused(block(CoulombFriction{1.0, 0.0}));
  refused([](ModelSpec& spec) { spec.state_terms[0].cv = 1; });
  refused([](ModelSpec& spec) { spec.state_terms.push_back(spec.state_terms[0]); });
  refused([](ModelSpec& spec) { spec.channels.clear(); });
  refused([](ModelSpec& spec) {
    std::get<TransferFunction>(spec.channels[0].dynamics).integrating = true;
  });
  refused([](ModelSpec& spec) {
    spec.channels[0].dynamics = mpm::TankChain{{10.0}, 0.0, 0.0, {}, 0.0, 0.0};
  });
}
