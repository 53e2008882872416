#include "core/model/linear_model.hpp"
#include "core/model/static_blocks.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/allocation_counter.hpp"

namespace {

using Eigen::VectorXd;
using mpm::ChannelSpec;
using mpm::DiscreteFilter;
using mpm::LinearModel;
using mpm::ModelSpec;
using mpm::StepResponse;
using mpm::TransferFunction;

constexpr double kUlp = 2.3e-16;

template <class Dynamics>
ModelSpec siso(const Dynamics& dynamics, double sample_time_s = 1.0) {
  ModelSpec spec;
  spec.sample_time_s = sample_time_s;
  spec.input_count = 1;
  spec.cv_count = 1;
  spec.channels.push_back({0, 0, dynamics});
  return spec;
}

VectorXd step_response(const ModelSpec& spec, int length) {
  LinearModel model(spec);
  VectorXd response(length);
  for (int k = 0; k < length; ++k) {
    response(k) = model.output()(0);
    model.advance(VectorXd::Ones(1));
  }
  return response;
}

VectorXd simulate(const ModelSpec& spec, const VectorXd& input) {
  LinearModel model(spec);
  VectorXd response(input.size());
  for (Eigen::Index k = 0; k < input.size(); ++k) {
    response(k) = model.output()(0);
    model.advance(input.segment(k, 1));
  }
  return response;
}

VectorXd random_input(int length, unsigned seed) {
  std::mt19937_64 engine(seed);
  VectorXd input(length);
  for (double& value : input) value = static_cast<double>(engine() >> 11) * 0x1p-53 - 0.5;
  return input;
}

ModelSpec shell() {  // eq. (4.1) of Carlsson 2010
  constexpr double kGain[3][3] = {{4.05, 1.77, 5.88}, {5.39, 5.72, 6.90}, {4.38, 4.42, 7.20}};
  constexpr double kTime[3][3] = {{50, 60, 50}, {50, 60, 40}, {33, 44, 19}};
  constexpr double kDead[3][3] = {{6, 7, 6}, {4, 3, 3}, {5, 5, 0}};
  ModelSpec spec;
  spec.input_count = 3;
  spec.cv_count = 3;
  for (int cv = 0; cv < 3; ++cv)
    for (int mv = 0; mv < 3; ++mv)
      spec.channels.push_back(
          {cv, mv, TransferFunction{kGain[cv][mv], {kTime[cv][mv]}, 0.0, kDead[cv][mv], false}});
  return spec;
}

}  // namespace

TEST_CASE("a first-order channel is the closed form to rounding") {
  for (const double time_constant_s : {0.01, 0.7, 19.0, 50.0, 1e5}) {
    const TransferFunction channel{4.05, {time_constant_s}, 0.0, 6.0, false};
    const VectorXd pulse = LinearModel(siso(channel)).impulse_response(0, 0, 60);
    // h(7 + l) = K (1 - a) a^l, a = exp(-T / tau); y(k) sees u(k-1-6).
    const double first = -4.05 * std::expm1(-1.0 / time_constant_s);
    for (int k = 0; k < 60; ++k) {
      const double expected = k < 7 ? 0.0 : first * std::exp(-(k - 7) / time_constant_s);
      CHECK(std::abs(pulse(k) - expected) <= 1e-14 * first);
    }
  }
}

TEST_CASE("several time constants follow the continuous step response at the samples") {
  const double t2 = 7.0, t1 = 3.0;
  struct Case {
    TransferFunction channel;
    double (*response)(double);
    double tolerance;
  };
  const Case cases[] = {
      // 1 - (T1 e^{-t/T1} - T2 e^{-t/T2}) / (T1 - T2)
      {{1.0, {t1, t2}, 0.0, 0.0, false},
       [](double t) { return 1.0 - (3.0 * std::exp(-t / 3.0) - 7.0 * std::exp(-t / 7.0)) / -4.0; },
       1e-14},
      // equal ones: Erlang distribution functions
      {{1.0, {t1, t1}, 0.0, 0.0, false},
       [](double t) { return 1.0 - std::exp(-t / 3.0) * (1.0 + t / 3.0); },
       1e-14},
      {{1.0, {t1, t1, t1}, 0.0, 0.0, false},
       [](double t) { return 1.0 - std::exp(-t / 3.0) * (1.0 + t / 3.0 + t * t / 18.0); },
       1e-14},
      // nearly equal: partial fractions in long double as the reference would lose 9 digits, the
      // Erlang function is right to 1e-9 / 3
      {{1.0, {t1, t1 * (1.0 + 1e-9)}, 0.0, 0.0, false},
       [](double t) { return 1.0 - std::exp(-t / 3.0) * (1.0 + t / 3.0); },
       1e-9},
      // stiff: tau = 1e-4 and 1e3 s at 1 s
      {{1.0, {1e-4, 1e3}, 0.0, 0.0, false},
       [](double t) { return t == 0.0 ? 0.0 : 1.0 - (1e3 * std::exp(-t / 1e3)) / (1e3 - 1e-4); },
       1e-13},
      // lead over two lags: 1 + ((T1-L) e^{-t/T1} - (T2-L) e^{-t/T2}) / (T2 - T1), L = 5
      {{1.0, {t1, t2}, 5.0, 0.0, false},
       [](double t) { return 1.0 + (-2.0 * std::exp(-t / 3.0) - 2.0 * std::exp(-t / 7.0)) / 4.0; },
       1e-14},
      // integrating with one lag: t - T (1 - e^{-t/T})
      {{1.0, {t1}, 0.0, 0.0, true}, [](double t) { return t + 3.0 * std::expm1(-t / 3.0); }, 1e-14},
      // integrating alone, and with a lead: t + L
      {{1.0, {}, 0.0, 0.0, true}, [](double t) { return t; }, 1e-14},
      {{1.0, {}, 2.0, 0.0, true}, [](double t) { return t == 0.0 ? 0.0 : t + 2.0; }, 1e-14},
      // lead over one lag jumps by L / T; the sample at 0 is taken before the jump
      {{1.0, {t1}, 2.0, 0.0, false},
       [](double t) { return t == 0.0 ? 0.0 : 1.0 - (1.0 - 2.0 / 3.0) * std::exp(-t / 3.0); },
       1e-14},
      // pure gain
      {{1.0, {}, 0.0, 0.0, false}, [](double t) { return t == 0.0 ? 0.0 : 1.0; }, 0.0},
  };
  for (const Case& test : cases) {
    const VectorXd response = step_response(siso(test.channel), 50);
    for (int k = 0; k < 50; ++k) {
      CAPTURE(k, test.channel.time_constants_s, test.channel.lead_s, test.channel.integrating);
      const double expected = test.response(k);
      CHECK(std::abs(response(k) - expected) <=
            (test.tolerance + 8 * kUlp * k) * (1.0 + std::abs(expected)));
    }
  }
}

TEST_CASE("a fractional dead time shifts the continuous response") {
  for (const double dead_time_s : {0.0, 0.3, 0.5, 1.0, 2.25, 3.999}) {
    const TransferFunction channel{2.0, {4.0, 9.0}, 0.0, dead_time_s, false};
    const VectorXd response = step_response(siso(channel), 40);
    for (int k = 0; k < 40; ++k) {
      const double t = k - dead_time_s;
      // Step response of 2 / ((4s+1)(9s+1)), delayed.
      const double expected =
          t <= 0.0 ? 0.0 : 2.0 + 2.0 * (4.0 * std::exp(-t / 4.0) - 9.0 * std::exp(-t / 9.0)) / 5.0;
      CAPTURE(dead_time_s, k);
      CHECK(std::abs(response(k) - expected) < 4e-14);
    }
  }
}

TEST_CASE("a fractional dead time equals a simulation on a ten times finer grid") {
  // 3.7 s at 1 s is 37 whole steps at 0.1 s; the input is held over ten of them.
  TransferFunction channel{1.5, {6.0}, 0.0, 3.7, false};
  const VectorXd input = random_input(200, 1);
  const VectorXd coarse = simulate(siso(channel, 1.0), input);
  VectorXd held(2000);
  for (int k = 0; k < 2000; ++k) held(k) = input(k / 10);
  const VectorXd fine = simulate(siso(channel, 0.1), held);
  for (int k = 0; k < 200; ++k) CHECK(std::abs(coarse(k) - fine(10 * k)) < 2e-13);
}

TEST_CASE("a dead time that is a whole number of samples up to rounding is that number") {
  // 0.6 / 0.1 = 5.999999999999999 in binary.
  const VectorXd pulse =
      LinearModel(siso(TransferFunction{1.0, {}, 0.0, 0.6, false}, 0.1)).impulse_response(0, 0, 12);
  CHECK(pulse(7) == 1.0);
  CHECK(pulse.sum() == 1.0);
}

TEST_CASE("transfer function, filter, step response and state space agree") {
  const double a = std::exp(-1.0 / 12.0);
  const TransferFunction transfer{3.0, {12.0}, 0.0, 2.0, false};
  const DiscreteFilter filter{{3.0 * (1.0 - a)}, {1.0, -a}, 2};
  StepResponse response;
  for (int k = 0; k < 600; ++k)
    response.values.push_back(k < 3 ? 0.0 : 3.0 * (1.0 - std::pow(a, k - 2)));
  ModelSpec space;
  space.input_count = 1;
  space.cv_count = 1;
  mpm::StateSpaceSpec system;
  system.a = Eigen::MatrixXd::Zero(3, 3);  // lag, then two steps of delay
  system.a(0, 0) = a;
  system.a(1, 0) = 1.0;
  system.a(2, 1) = 1.0;
  system.b = Eigen::Vector3d(3.0 * (1.0 - a), 0.0, 0.0);
  system.c = Eigen::RowVector3d(0.0, 0.0, 1.0);
  system.d = Eigen::MatrixXd::Zero(1, 1);
  space.state_space = system;

  const VectorXd input = random_input(2000, 2);
  const VectorXd reference = simulate(siso(transfer), input);
  CHECK((simulate(siso(filter), input) - reference).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((simulate(siso(response), input) - reference).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((simulate(space, input) - reference).cwiseAbs().maxCoeff() < 1e-13);

  for (const ModelSpec& spec : {siso(transfer), siso(filter), siso(response), space}) {
    const LinearModel model(spec);
    CHECK(model.steady_gain()(0, 0) == Approx(3.0).epsilon(1e-13));
    CHECK_FALSE(model.integrating()(0, 0));
    CHECK(model.longest_dead_time_samples() == 2.0);
    // The step response has 63 % after 12 samples, and whole samples only.
    CHECK(model.slowest_time_constant_samples() == Approx(12.0).margin(0.5));
    // 1 - a^n >= 0.99 at n >= 12 ln 100 = 55.3, two samples of delay.
    CHECK(model.settling_samples(0.01) == 58);
  }
}

TEST_CASE("higher-order filters follow their difference equation") {
  // y(k) = 1.3 y(k-1) - 0.4 y(k-2) + 0.5 u(k-4) - 0.2 u(k-5), all divided by 2 in the spec.
  const DiscreteFilter filter{{1.0, -0.4}, {2.0, -2.6, 0.8}, 3};
  const VectorXd input = random_input(300, 3);
  const VectorXd response = simulate(siso(filter), input);
  const auto at = [](const VectorXd& signal, int k) { return k < 0 ? 0.0 : signal(k); };
  for (int k = 0; k < 300; ++k) {
    const double expected = 1.3 * at(response, k - 1) - 0.4 * at(response, k - 2) +
                            0.5 * at(input, k - 4) - 0.2 * at(input, k - 5);
    CHECK(std::abs(response(k) - expected) < 1e-13);
  }
  CHECK(LinearModel(siso(filter)).steady_gain()(0, 0) == Approx(3.0));  // 0.6 / 0.2
}

TEST_CASE("what feeds through acts on the input just before the sample") {
  const VectorXd direct = step_response(siso(StepResponse{{0.7}}), 4);
  CHECK(direct(0) == 0.0);
  CHECK(direct(1) == 0.7);
  CHECK(direct(3) == 0.7);

  ModelSpec space;
  space.input_count = 1;
  space.cv_count = 1;
  mpm::StateSpaceSpec system;
  system.a = Eigen::MatrixXd::Constant(1, 1, 0.5);
  system.b = Eigen::MatrixXd::Ones(1, 1);
  system.c = Eigen::MatrixXd::Ones(1, 1);
  system.d = Eigen::MatrixXd::Constant(1, 1, 2.0);
  system.x0 = VectorXd::Constant(1, 4.0);
  space.state_space = system;
  // x = 4, 3, 2.5, 2.25 under u = 1; y(k) = x(k) + 2 u(k-1), nothing given before k = 0.
  const VectorXd response = step_response(space, 4);
  CHECK(response(0) == 4.0);
  CHECK(response(1) == 5.0);
  CHECK(response(2) == 4.5);
  CHECK(response(3) == 4.25);
  // h = 0, CB + D, CAB, CA^2B
  const VectorXd pulse = LinearModel(space).impulse_response(0, 0, 4);
  CHECK(pulse == Eigen::Vector4d(0.0, 3.0, 0.5, 0.25));
  CHECK(LinearModel(space).steady_gain()(0, 0) == Approx(4.0));  // 1 / (1 - 0.5) + 2
}

TEST_CASE("integrating channels are found in every form and rest where they are") {
  // 0.2 / (s (5s+1)) at 2 s has poles 1 and a. Its step response 0.2 (t - 5 (1 - e^{-t/5})) gives
  // the pulses h(1), h(2), and h(1) = b0, h(2) = b1 + (1 + a) b0.
  const double a = std::exp(-2.0 / 5.0);
  const double h1 = 0.2 * (2.0 - 5.0 * (1.0 - a));
  const double h2 = 0.2 * (4.0 - 5.0 * (1.0 - a * a)) - h1;
  const DiscreteFilter filter{{h1, h2 - (1.0 + a) * h1}, {1.0, -1.0 - a, a}, 0};

  const ModelSpec lag_spec = siso(TransferFunction{0.2, {5.0}, 0.0, 0.0, true}, 2.0);
  const ModelSpec filter_spec = siso(filter, 2.0);
  for (const ModelSpec& spec : {lag_spec, filter_spec}) {
    LinearModel model(spec);
    CHECK(model.integrating()(0, 0));
    CHECK(model.steady_gain()(0, 0) == Approx(0.4));  // 0.2 per second, 2 s
    CHECK(model.settling_samples() == 0);
    model.reset_steady(VectorXd::Ones(1));
    for (int k = 0; k < 5; ++k) {
      CHECK(model.output()(0) == Approx(0.4 * k).margin(1e-12));  // the ramp goes on
      model.advance(VectorXd::Ones(1));
    }
  }
}

TEST_CASE("a state space with an integrator splits at its pole 1") {
  // An integrator of slope 0.5 beside a lag of gain 2 (pole 0.9), mixed by a change of basis.
  ModelSpec spec;
  spec.input_count = 1;
  spec.cv_count = 2;
  mpm::StateSpaceSpec system;
  Eigen::Matrix2d basis;
  basis << 1.0, 2.0, -1.0, 1.0;
  const Eigen::Matrix2d diagonal = Eigen::Vector2d(1.0, 0.9).asDiagonal();
  system.a = basis * diagonal * basis.inverse();
  system.b = basis * Eigen::Vector2d(0.5, 0.2);
  system.c = basis.inverse();  // CV 0 sees the integrator, CV 1 the lag
  system.d = Eigen::MatrixXd::Zero(2, 1);
  spec.state_space = system;
  LinearModel model(spec);
  CHECK(model.integrating()(0, 0));
  CHECK_FALSE(model.integrating()(1, 0));
  CHECK(model.steady_gain()(0, 0) == Approx(0.5));
  CHECK(model.steady_gain()(1, 0) == Approx(2.0));
  model.reset_steady(VectorXd::Constant(1, 3.0));
  CHECK(model.output()(0) == Approx(0.0).margin(1e-12));
  CHECK(model.output()(1) == Approx(6.0));
}

TEST_CASE("static blocks in front of and behind the linear part") {
  ModelSpec spec = siso(TransferFunction{1.0, {}, 0.0, 0.0, false});
  spec.input_origin = VectorXd::Constant(1, 10.0);
  spec.output_origin = VectorXd::Constant(1, 100.0);
  const auto respond = [&](std::initializer_list<double> inputs) {
    LinearModel model(spec);
    std::vector<double> outputs;
    for (const double input : inputs) {
      model.advance(VectorXd::Constant(1, input));
      outputs.push_back(model.output()(0));
    }
    return outputs;
  };
  using Values = std::vector<double>;
  // All expectations by hand from the definitions in model_spec.hpp and static_blocks.hpp.
  SECTION("operating point") { CHECK(respond({10, 11, 8}) == Values{100, 101, 98}); }
  SECTION("polynomial of the deviation") {
    spec.input_blocks = {mpm::Polynomial{{2.0, 0.5}}};
    CHECK(respond({10, 12, 8}) == Values{100, 106, 98});
  }
  SECTION("input saturation") {
    spec.input_blocks = {mpm::Saturation{9.0, 12.0}};
    CHECK(respond({20, 11, -5}) == Values{102, 101, 99});
  }
  SECTION("play of width 2") {
    spec.input_blocks = {mpm::Deadband{2.0}};
    CHECK(respond({10.5, 13, 12, 11, 10, 14}) == Values{100, 102, 102, 102, 101, 103});
  }
  SECTION("stiction, band 2, jump 1") {
    // Waits 2 after a reversal, then jumps by 1; waits 1 after a stop; follows 0.5 behind.
    spec.input_blocks = {mpm::Stiction{2.0, 1.0}};
    CHECK(respond({11, 12, 13, 12, 11, 10.75, 10, 10, 9.5, 8.5}) ==
          Values{100, 101.5, 102.5, 102.5, 102.5, 101.25, 100.5, 100.5, 100.5, 99});
  }
  SECTION("output saturation, offset and scale") {
    spec.output_blocks = {mpm::Saturation{99.0, 101.0}};
    CHECK(respond({15, 5, 10.5}) == Values{101, 99, 100.5});
    spec.output_blocks = {mpm::Offset{-3.0}};
    CHECK(respond({11}) == Values{98});
    spec.output_blocks = {mpm::Scale{2.0}};
    CHECK(respond({11}) == Values{102});
  }
}

TEST_CASE("an input held for ever gives the steady output and keeps it") {
  ModelSpec spec = shell();
  spec.channels[1].dynamics = DiscreteFilter{{0.3, 0.1}, {1.0, -1.2, 0.4}, 4};
  spec.channels[5].dynamics = StepResponse{{0.0, 0.0, 1.0, 3.0, 2.5}};
  LinearModel model(spec);
  const Eigen::Vector3d input(0.4, -1.0, 2.0);
  model.reset_steady(input);
  const VectorXd steady = model.output();
  CHECK((steady - model.steady_gain() * input).cwiseAbs().maxCoeff() < 1e-12);
  for (int k = 0; k < 100; ++k) {
    model.advance(input);
    CHECK((model.output() - steady).cwiseAbs().maxCoeff() < 1e-12);
  }
}

// By hand from the two limits (He et al. 2007): static (S+J)/2 = 1.5, moving (S-J)/2 = 0.5.
TEST_CASE("a valve that slips once sticks anew after every slip") {
  mpm::InputElement once(mpm::Stiction{2.0, 1.0, true}, 0.0);
  mpm::InputElement moves_on(mpm::Stiction{2.0, 1.0, false}, 0.0);
  const std::vector<double> command = {1.0, 1.6, 2.0, 2.5, 2.7, 1.5};
  const std::vector<double> slips = {0.0, 1.1, 1.1, 1.1, 2.2, 2.2};
  const std::vector<double> follows = {0.0, 1.1, 1.5, 2.0, 2.2, 2.2};
  for (std::size_t k = 0; k < command.size(); ++k) {
    CHECK(once.apply(command[k], 0.0) == Approx(slips[k]));
    CHECK(moves_on.apply(command[k], 0.0) == Approx(follows[k]));
  }
}

TEST_CASE("an input that is not finite counts as unchanged") {
  LinearModel model(siso(TransferFunction{1.0, {3.0}, 0.0, 0.0, false}));
  LinearModel reference = model;
  model.advance(VectorXd::Constant(1, 2.0));
  model.advance(VectorXd::Constant(1, std::nan("")));
  reference.advance(VectorXd::Constant(1, 2.0));
  reference.advance(VectorXd::Constant(1, 2.0));
  CHECK(model.output() == reference.output());
}

TEST_CASE("a copy runs on by itself") {
  LinearModel model(shell());
  for (int k = 0; k < 20; ++k) model.advance(VectorXd::Ones(3));
  LinearModel copy = model;
  const VectorXd before = model.output();
  copy.advance(VectorXd::Ones(3));
  CHECK(model.output() == before);
  model.advance(VectorXd::Ones(3));
  CHECK(model.output() == copy.output());
}

TEST_CASE("stepping, resetting and copying over do not allocate") {
  ModelSpec spec = shell();
  spec.channels[1].dynamics = DiscreteFilter{{0.3, 0.1}, {1.0, -1.2, 0.4}, 4};
  spec.channels[5].dynamics = StepResponse{{0.0, 0.0, 1.0, 3.0, 2.5}};
  spec.input_blocks = {mpm::Polynomial{{1.0, 0.1}}, mpm::Stiction{0.1, 0.05}, std::nullopt};
  LinearModel model(spec);
  LinearModel other = model;
  const VectorXd input = VectorXd::Constant(3, 0.3);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 100; ++k) model.advance(input);
  other = model;
  model.reset_steady(input);
  model.reset();
  CHECK(mpm::test::allocation_count() == before);
}

TEST_CASE("impossible models are refused") {
  CHECK_THROWS_AS(LinearModel(siso(TransferFunction{1.0, {-1.0}, 0.0, 0.0, false})),
                  std::invalid_argument);
  CHECK_THROWS_AS(LinearModel(siso(TransferFunction{1.0, {1.0}, 0.0, -1.0, false})),
                  std::invalid_argument);
  CHECK_THROWS_AS(LinearModel(siso(TransferFunction{1.0, {}, 2.0, 0.0, false})),
                  std::invalid_argument);
  CHECK_THROWS_AS(LinearModel(siso(DiscreteFilter{{1.0}, {0.0, 1.0}, 0})), std::invalid_argument);
  CHECK_THROWS_AS(LinearModel(siso(StepResponse{})), std::invalid_argument);
  ModelSpec twice = siso(TransferFunction{});
  twice.channels.push_back(twice.channels[0]);
  CHECK_THROWS_AS(LinearModel(twice), std::invalid_argument);
  ModelSpec outside = siso(TransferFunction{});
  outside.channels[0].input = 1;
  CHECK_THROWS_AS(LinearModel(outside), std::invalid_argument);
}
