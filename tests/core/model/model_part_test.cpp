#include "core/model/model_part.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/model/linear_model.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::model_part_test {
namespace {

/// Steps of one channel of a model, in the model's samples.
Eigen::VectorXd steps(const ModelSpec& model, int cv, int input, int length) {
  Eigen::VectorXd step = LinearModel(model).impulse_response(cv, input, length);
  for (int k = 1; k < length; ++k) step(k) += step(k - 1);
  return step;
}

ModelSpec two_by_two() { return test::OpenLoopUnit().model; }

/// 0.3 z^-1 / (1 - 0.9 z^-1), three samples later, of CV 0 and input 0.
ModelSpec in_samples() {
  ModelSpec model = two_by_two();
  model.channels[0].dynamics = DiscreteFilter{{0.3}, {1.0, -0.9}, 3};
  return model;
}

}  // namespace

TEST_CASE("at a longer sample time a channel answers a step as it did") {
  const double cycle = GENERATE(2.0, 5.0, 7.5);
  const ModelSpec model = GENERATE(two_by_two(), in_samples());
  const auto part = at_longer_sample_time(model, {0}, cycle);
  REQUIRE(part);
  CHECK(part->cv_count == 1);
  CHECK(part->sample_time_s == cycle * model.sample_time_s);
  for (int input = 0; input < 2; ++input) {
    const Eigen::VectorXd fine = steps(model, 0, input, 200);
    const Eigen::VectorXd coarse = steps(*part, 0, input, 20);
    for (int n = 0; n < 20; ++n) {
      const double at = n * cycle;
      if (at != std::floor(at) || at >= 200.0) continue;
      // Transfer functions exactly; what was in samples is followed to within 0.1 % of its end.
      CHECK(coarse(n) == Approx(fine(static_cast<int>(at))).margin(1.1e-3 * std::abs(fine(199))));
    }
  }
}

TEST_CASE("a state space becomes step responses, and channels that do nothing are none") {
  ModelSpec model = two_by_two();
  model.channels.clear();
  StateSpaceSpec states;
  states.a = Eigen::Matrix2d{{0.9, 0.0}, {0.0, 0.8}};
  states.b = Eigen::Matrix2d{{1.0, 0.0}, {0.0, 1.0}};
  states.c = Eigen::Matrix2d{{0.5, 0.0}, {0.2, 0.3}};
  states.d = Eigen::Matrix2d::Zero();
  model.state_space = states;
  const auto part = at_longer_sample_time(model, {0}, 4.0);
  REQUIRE(part);
  CHECK_FALSE(part->state_space);
  REQUIRE(part->channels.size() == 1);
  CHECK(part->channels[0].input == 0);
  // 0.5 (1 - 0.9^k) / 0.1
  const Eigen::VectorXd coarse = steps(*part, 0, 0, 10);
  for (int n = 0; n < 10; ++n)
    CHECK(coarse(n) == Approx(5.0 * (1.0 - std::pow(0.9, 4.0 * n))).margin(5.5e-3));
}

// As one by one: each CV's channels are its own.
TEST_CASE("several CVs at a longer sample time are as each of them alone") {
  ModelSpec model = in_samples();
  model.channels[3].dynamics = StepResponse{{0.0, 0.5, 0.8, 1.0}};
  const auto both = at_longer_sample_time(model, {0, 1}, 5.0);
  REQUIRE(both);
  CHECK(both->cv_count == 2);
  for (int cv = 0; cv < 2; ++cv) {
    const auto one = at_longer_sample_time(model, {cv}, 5.0);
    REQUIRE(one);
    for (int input = 0; input < 2; ++input)
      CHECK(steps(*both, cv, input, 20) == steps(*one, 0, input, 20));
  }
}

TEST_CASE("what integrates in samples has no step response that settles") {
  ModelSpec model = two_by_two();
  model.channels[1].dynamics = DiscreteFilter{{0.1}, {1.0, -1.0}, 0};
  CHECK_FALSE(at_longer_sample_time(model, {0}, 3.0));
  CHECK(at_longer_sample_time(model, {1}, 3.0));
}

TEST_CASE("a part has the CVs that were asked for, in their order") {
  ModelSpec model = two_by_two();
  model.disturbances = {{.cv = 1}, {.cv = 0}};
  model.output_blocks[1] = Offset{0.5};
  const ModelSpec part = of_cvs(model, {1});
  CHECK(part.cv_count == 1);
  CHECK(part.input_count == 2);
  REQUIRE(part.channels.size() == 2);
  CHECK(part.channels[0].cv == 0);
  CHECK(std::get<TransferFunction>(part.channels[1].dynamics).gain == 1.5);
  CHECK(part.disturbances.size() == 1);
  CHECK(std::get<Offset>(*part.output_blocks.at(0)).bias == 0.5);
  CHECK(part.output_origin(0) == 2.0);
}

}  // namespace mpm::model_part_test
