// What the model holds around its dynamics: blocks of single channels, disturbances, the clock.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/model/disturbance.hpp"
#include "core/model/linear_model.hpp"
#include "tests/allocation_counter.hpp"

namespace {

using Eigen::VectorXd;
using mpm::DisturbanceShape;
using mpm::DisturbanceTerm;
using mpm::LinearModel;
using mpm::ModelSpec;
using mpm::TransferFunction;

using Values = std::vector<double>;

/// Two CVs behind one input at 10; pure gains 1, so that outputs show what the channels see.
ModelSpec two_gains() {
  ModelSpec spec;
  spec.input_count = 1;
  spec.cv_count = 2;
  spec.input_origin = VectorXd::Constant(1, 10.0);
  spec.channels.push_back({0, 0, TransferFunction{1.0, {}, 0.0, 0.0, false}});
  spec.channels.push_back({1, 0, TransferFunction{1.0, {}, 0.0, 0.0, false}});
  return spec;
}

Values respond(const ModelSpec& spec, int cv, const Values& inputs) {
  LinearModel model(spec);
  Values outputs;
  for (const double input : inputs) {
    model.advance(VectorXd::Constant(1, input));
    outputs.push_back(model.output()(cv));
  }
  return outputs;
}

/// Nothing but a disturbance, at 2 s.
ModelSpec disturbed(const DisturbanceTerm& disturbance) {
  ModelSpec spec;
  spec.sample_time_s = 2.0;
  spec.cv_count = 1;
  spec.disturbances = {disturbance};
  return spec;
}

}  // namespace

TEST_CASE("a block of one channel leaves the other channels of its input alone") {
  ModelSpec spec = two_gains();
  const Values inputs = {10.5, 13, 12, 11, 10, 14};
  SECTION("play of width 2") {  // expectations as in linear_model_test.cpp
    spec.channels[0].input_block = mpm::Deadband{2.0};
    CHECK(respond(spec, 0, inputs) == Values{0, 2, 2, 2, 1, 3});
    CHECK(respond(spec, 1, inputs) == Values{0.5, 3, 2, 1, 0, 4});
  }
  SECTION("each channel has its own valve position") {
    spec.channels[0].input_block = mpm::Deadband{2.0};
    spec.channels[1].input_block = mpm::Deadband{6.0};
    CHECK(respond(spec, 0, inputs) == Values{0, 2, 2, 2, 1, 3});
    CHECK(respond(spec, 1, inputs) == Values{0, 0, 0, 0, 0, 1});
  }
  SECTION("after the input's own block, in input units again") {
    spec.input_blocks = {mpm::Saturation{9.0, 12.0}};
    spec.channels[0].input_block = mpm::Polynomial{{0.0, 1.0}};  // of 13: (12 - 10)^2
    spec.channels[1].input_block = mpm::Saturation{9.5, 20.0};   // of 5: 9 - 10, then 9.5 - 10
    CHECK(respond(spec, 0, {13, 5}) == Values{4, 1});
    CHECK(respond(spec, 1, {13, 5}) == Values{2, -0.5});
  }
}

TEST_CASE("what an input does more of on one side adds nothing at the operating point") {
  // Operating point 10, gain 1, y(k) is what u(k-1) acts like.
  ModelSpec spec = two_gains();
  const Values inputs = {10, 12, 8, 14, 6};
  spec.input_blocks = {mpm::TwoSided{2.0, 0.5}};  // at 10
  CHECK(respond(spec, 1, inputs) == Values{0, 4, -1, 8, -2});
  spec.input_blocks = {mpm::TwoSided{2.0, 0.5, 12.0}};  // of 10: 0.5 * -2
  CHECK(respond(spec, 1, inputs) == Values{0, 1, -1, 5, -2});
}

TEST_CASE("a product goes with where the other input stands at that time") {
  // Operating points 10 and 5; y(k) is what u(k-1) acts like.
  ModelSpec spec = two_gains();
  spec.input_count = 2;
  spec.input_origin = (VectorXd(2) << 10, 5).finished();
  const auto respond_to = [](const ModelSpec& of, int cv) {
    LinearModel model(of);
    Values values;
    for (const auto& [u, v] : {std::pair{12.0, 5.0}, {12.0, 7.0}, {8.0, 7.0}, {10.0, 9.0}}) {
      model.advance((VectorXd(2) << u, v).finished());
      values.push_back(model.output()(cv));
    }
    return values;
  };
  spec.input_blocks = {mpm::Product{1, 0.25}, {}};
  CHECK(respond_to(spec, 0) == Values{2, 3, -3, 0});
  spec.input_blocks = {mpm::Product{1, 0.25, 2.0}, {}};
  CHECK(respond_to(spec, 0) == Values{4, 5, -5, 0});
  spec.input_blocks = {};
  spec.channels[1].input_block = mpm::Product{1, 0.25};
  CHECK(respond_to(spec, 0) == Values{2, 2, -2, 0});
  CHECK(respond_to(spec, 1) == Values{2, 3, -3, 0});

  // Held for ever at 12 and 9, what it does is twice as much.
  spec.channels[1].input_block.reset();
  spec.input_blocks = {mpm::Product{1, 0.25}, {}};
  LinearModel model(spec);
  model.reset_steady((VectorXd(2) << 12, 9).finished());
  CHECK(model.output()(0) == 4);

  for (const mpm::Product& none : {mpm::Product{0, 1.0}, mpm::Product{2, 1.0},
                                   mpm::Product{-1, 1.0}, mpm::Product{1, std::nan("")}}) {
    spec.input_blocks = {none, {}};
    CHECK_THROWS_AS(LinearModel(spec), std::invalid_argument);
  }
}

TEST_CASE("a channel block with dynamics is the same block in front of that channel alone") {
  for (const mpm::InputBlock& block :
       {mpm::InputBlock(mpm::Stiction{2.0, 1.0}), mpm::InputBlock(mpm::Polynomial{{1.0, 0.3}})}) {
    ModelSpec own = two_gains();
    own.channels[0].dynamics = TransferFunction{3.0, {8.0, 2.0}, 1.0, 2.4, false};
    own.channels[1].dynamics = mpm::StepResponse{{0.0, 0.5, 1.5, 1.0}};
    ModelSpec all = own;
    own.channels[1].input_block = block;
    all.input_blocks = {block};
    LinearModel model(own), reference(all);
    for (int k = 0; k < 200; ++k) {
      REQUIRE(model.output()(1) == Approx(reference.output()(1)).margin(1e-13));
      const VectorXd input = VectorXd::Constant(1, 10.0 + 5.0 * std::sin(0.1 * k));
      model.advance(input);
      reference.advance(input);
    }
    model.reset_steady(VectorXd::Constant(1, 13.0));
    reference.reset_steady(VectorXd::Constant(1, 13.0));
    CHECK(model.output()(1) == reference.output()(1));
    CHECK(model.impulse_response(1, 0, 5) == Eigen::VectorXd{{0.0, 0.5, 1.0, -0.5, 0.0}});
  }
}

TEST_CASE("an actuator sticks or leaks from its onset on, by the clock of the data") {
  // Operating point 10, gain 1, sampled once a second: y(k) is u(k-1) - 10.
  const auto values = [](const mpm::InputBlock& block, double start_s, const Values& inputs) {
    ModelSpec spec = two_gains();
    spec.input_blocks = {block};
    LinearModel model(spec);
    model.set_time_s(start_s);
    model.reset_steady(VectorXd::Constant(1, inputs.front()));
    Values result = {model.output()(1)};
    for (const double input : inputs) {
      model.advance(VectorXd::Constant(1, input));
      result.push_back(model.output()(1));
    }
    return result;
  };
  const Values inputs = {11, 12, 13, 14};
  SECTION("within the data: u(102) is the first that it holds back") {
    CHECK(values(mpm::Stuck{10.5, 102.0}, 100.0, inputs) == Values{1, 1, 2, 0.5, 0.5});
    CHECK(values(mpm::InputOffset{5.0, 102.0}, 100.0, inputs) == Values{1, 1, 2, 8, 9});
  }
  SECTION("with the first sample: what came before was sound") {
    CHECK(values(mpm::Stuck{10.5, 100.0}, 100.0, inputs) == Values{1, 0.5, 0.5, 0.5, 0.5});
    CHECK(values(mpm::InputOffset{5.0, 100.0}, 100.0, inputs) == Values{1, 6, 7, 8, 9});
  }
  SECTION("before the data, or always: they begin at rest with it") {
    CHECK(values(mpm::Stuck{10.5, 50.0}, 100.0, inputs) == Values{0.5, 0.5, 0.5, 0.5, 0.5});
    CHECK(values(mpm::Stuck{10.5}, 100.0, inputs) == Values{0.5, 0.5, 0.5, 0.5, 0.5});
    CHECK(values(mpm::InputOffset{5.0}, 100.0, inputs) == Values{6, 6, 7, 8, 9});
  }
  SECTION("after the data: never") {
    CHECK(values(mpm::Stuck{10.5, 200.0}, 100.0, inputs) == Values{1, 1, 2, 3, 4});
  }
}

TEST_CASE("disturbances follow the clock of the data") {
  // Sampled at 0, 2, 4, ... s; expectations by hand from model_spec.hpp.
  const auto values = [](const DisturbanceTerm& disturbance, double start_s, int samples) {
    LinearModel model(disturbed(disturbance));
    model.set_time_s(start_s);
    Values result;
    for (int k = 0; k < samples; ++k) {
      result.push_back(model.output()(0));
      model.advance(VectorXd(0));
    }
    return result;
  };
  DisturbanceTerm term;
  term.onset_s = 4.0;
  term.size = 3.0;
  SECTION("a step, for a while") {
    CHECK(values(term, 0.0, 4) == Values{0, 0, 3, 3});
    term.until_s = 7.0;
    CHECK(values(term, 0.0, 6) == Values{0, 0, 3, 3, 0, 0});
    CHECK(values(term, 5.0, 2) == Values{3, 0});
  }
  SECTION("a step through a lag, there and back") {
    term.time_constant_s = 5.0;
    term.until_s = 8.0;
    const Values result = values(term, 0.0, 8);
    for (int k = 0; k < 8; ++k) {
      const double t = 2.0 * k;
      double expected = 0.0;
      if (t >= 4.0) expected += 3.0 * (1.0 - std::exp(-(t - 4.0) / 5.0));
      if (t >= 8.0) expected -= 3.0 * (1.0 - std::exp(-(t - 8.0) / 5.0));
      CHECK(result[static_cast<std::size_t>(k)] == Approx(expected).margin(1e-15));
    }
  }
  SECTION("a step that passes, at once or through a lag") {
    term.decay_s = 6.0;
    for (const double lag : {0.0, 5.0}) {
      term.time_constant_s = lag;
      const Values result = values(term, 0.0, 8);
      for (int k = 0; k < 8; ++k) {
        const double since = 2.0 * k - 4.0;
        const double risen = lag > 0.0 ? 1.0 - std::exp(-since / lag) : 1.0;
        const double expected = since < 0.0 ? 0.0 : 3.0 * risen * std::exp(-since / 6.0);
        CHECK(result[static_cast<std::size_t>(k)] == Approx(expected).margin(1e-15));
      }
    }
  }
  SECTION("a drift, which stops") {
    term.shape = DisturbanceShape::kDrift;
    CHECK(values(term, 0.0, 5) == Values{0, 0, 0, 6, 12});
    term.until_s = 7.0;
    CHECK(values(term, 0.0, 6) == Values{0, 0, 0, 6, 9, 9});
  }
  SECTION("a sine, also before its onset and far from it") {
    term.shape = DisturbanceShape::kPeriodic;
    term.period_s = 8.0;
    const Values expected = {0, -3, 0, 3, 0};
    for (const double start_s : {0.0, 1.7e9}) {  // 1.7e9 = 8 x 212500000
      const Values result = values(term, start_s, 5);
      for (std::size_t k = 0; k < 5; ++k) CHECK(result[k] == Approx(expected[k]).margin(1e-12));
    }
  }
  SECTION("a square wave, whose first half is up") {
    term.shape = DisturbanceShape::kPeriodic;
    term.period_s = 8.0;
    term.square = true;
    CHECK(values(term, 0.0, 7) == Values{-3, -3, 3, 3, -3, -3, 3});
  }
}

TEST_CASE("a step at a sampling instant that rounding misses is not a sample late") {
  DisturbanceTerm term;
  term.onset_s = 0.3;  // 0.1 * 3 is above, 1.7e9 + ... may be below
  term.size = 1.0;
  for (const double start_s : {0.0, 1.7e9}) {
    ModelSpec spec = disturbed(term);
    spec.sample_time_s = 1.0;
    spec.disturbances[0].onset_s = start_s + 7.3;
    LinearModel model(spec);
    model.set_time_s(start_s + 0.3);
    int first = 0;
    for (int k = 0; model.output()(0) == 0.0 && k < 20; ++k, ++first) model.advance(VectorXd(0));
    CHECK(first == 7);
  }
}

TEST_CASE("disturbances add up and the sensor clips them") {
  ModelSpec spec = disturbed({0, DisturbanceShape::kDrift, 0.0, 1.0});
  DisturbanceTerm step;
  step.size = 0.5;
  step.onset_s = 2.0;
  spec.disturbances.push_back(step);
  spec.output_origin = VectorXd::Constant(1, 100.0);
  spec.output_blocks = {mpm::Saturation{0.0, 105.0}};
  LinearModel model(spec);
  Values result;
  for (int k = 0; k < 4; ++k) {
    result.push_back(model.output()(0));
    model.advance(VectorXd(0));
  }
  CHECK(result == Values{100, 102.5, 104.5, 105});
}

TEST_CASE("the clock goes with copies, and back with a reset") {
  LinearModel model(disturbed({0, DisturbanceShape::kDrift, 0.0, 1.0}));
  model.set_time_s(10.0);
  model.advance(VectorXd(0));
  LinearModel copy = model;
  copy.advance(VectorXd(0));
  CHECK(model.output()(0) == 12.0);
  CHECK(copy.output()(0) == 14.0);
  copy.reset();
  CHECK(copy.output()(0) == 10.0);
}

TEST_CASE("an extended model does not allocate while it runs") {
  ModelSpec spec = two_gains();
  spec.channels[0].dynamics = TransferFunction{1.0, {5.0}, 0.0, 1.5, false};
  spec.channels[0].input_block = mpm::Polynomial{{1.0, 0.1, 0.2}};
  spec.state_terms.push_back({0, 0, mpm::RestoringForce{0.1, 0.1}});
  spec.channels[1].dynamics = mpm::TankChain{{5.0, 3.0}, 0.0, -1.0, {1.2, 3.0}, 0.5, 0.7};
  spec.channels[1].input_block = mpm::Stiction{1.0, 0.5};
  spec.disturbances.push_back({0, DisturbanceShape::kPeriodic, 0.0, 1.0, 0.0, 50.0});
  LinearModel model(spec), other = model;
  const VectorXd input = VectorXd::Constant(1, 12.0);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 100; ++k) model.advance(input);
  other = model;
  model.set_time_s(5.0);
  model.reset_steady(input);
  model.reset();
  CHECK(mpm::test::allocation_count() == before);
}

TEST_CASE("impossible disturbances are refused") {
  const auto refused = [](auto change) {
    ModelSpec spec = disturbed({});
    change(spec.disturbances[0]);
    CHECK_THROWS_AS(LinearModel(spec), std::invalid_argument);
  };
  refused([](DisturbanceTerm& d) { d.cv = 1; });
  refused([](DisturbanceTerm& d) { d.onset_s = std::numeric_limits<double>::infinity(); });
  refused([](DisturbanceTerm& d) { d.size = std::nan(""); });
  refused([](DisturbanceTerm& d) { d.time_constant_s = -1.0; });
  refused([](DisturbanceTerm& d) { d.until_s = 0.0; });
  refused([](DisturbanceTerm& d) { d.decay_s = 0.0; });
  refused([](DisturbanceTerm& d) { d.shape = DisturbanceShape::kPeriodic; });
}
