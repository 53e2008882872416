#include "core/identify/diagnosis/extension.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::extension_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 500;

/// Two CVs of one input, sampled every 2 s from 1000 s on, with hardly any noise.
struct Bench {
  ModelSpec model = two_cvs();
  Recording recording;
  Problem problem;

  explicit Bench(double gain_ratio = 1.0)
      : recording(plant(gain_ratio)), problem(model, 1, recording, Tolerances{}, NoiseModel{}) {}

  static ModelSpec two_cvs() {
    ModelSpec two = test::model_of({lag(0, 0, 2.0, 20.0), lag(1, 0, 1.0, 10.0, 4.0)}, 1, 2);
    two.sample_time_s = 2.0;
    return two;
  }
  static Recording plant(double gain_ratio) {
    const VectorXd u = test::telegraph(1, kRows, 12);
    MatrixXd cvs(kRows, 2);
    cvs << gain_ratio * test::first_order(u, 2.0, 10.0), test::first_order(u, 1.0, 5.0, 2);
    cvs.col(0) += 0.01 * test::white(2, kRows);
    cvs.col(1) += 0.01 * test::white(3, kRows);
    Recording measured = test::recording_of(u, cvs);
    measured.sample_time_s = 2.0;
    measured.start_s = 1000.0;
    return measured;
  }
};

/// Found, and not fitted yet.
SearchResult found_with(const Effect& effect) {
  SearchResult found;
  found.named = {{effect, 42.0, 0.98, {}}};
  found.fit.effects = {effect};
  return found;
}

// The plant's gain is 1.3 times the model's: fitted and put into the model, it is the plant's.
TEST_CASE("the extended model is the plant") {
  Bench bench(1.3);
  SearchResult found =
      found_with({&causes::gain(), {0, 0}, {{&kGainRatio, 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}}});
  found.fit = bench.problem.fit(found.fit.effects, 0, {0, 1}, 10);
  found.named[0].effect = found.fit.effects[0];
  const ModelSpec extended = extend(bench.problem, found, {true}, {true, true});
  const auto& first = std::get<TransferFunction>(extended.channels[0].dynamics);
  CHECK(first.gain == Approx(2.6).epsilon(0.002));
  CHECK(first.time_constants_s[0] == Approx(20.0).epsilon(0.005));
  CHECK(extended.output_origin(0) == Approx(0.0).margin(0.005));
  // Nothing was found on the second CV: it stays to the last bit.
  const auto& second = std::get<TransferFunction>(extended.channels[1].dynamics);
  CHECK(second.gain == 1.0);
  CHECK(second.time_constants_s[0] == 10.0);
  CHECK(second.dead_time_s == 4.0);
  CHECK(extended.output_origin(1) == 0.0);
}

// By hand: small errors of 1.5, -2 and 0.5 tolerances, and a level.
TEST_CASE("small errors and levels go into the model beside what was found") {
  const Bench bench;
  SearchResult found = found_with({&causes::step_disturbance(), {1}, {{&kSize, 0.7}}, 50});
  CvFit fit;
  fit.cv = 1;
  const CvData& data = bench.problem.data(1);
  fit.beta = VectorXd::Zero(data.nuisances.cols());
  fit.beta.head(5) << 0.25, 0.0, 1.5, -2.0, 0.5;  // level, first state, the channel
  found.fit.cvs = {fit};
  const double level = 0.25 * data.nuisances(0, 0);
  const ModelSpec extended = extend(bench.problem, found, {true}, {true, true});
  const auto& channel = std::get<TransferFunction>(extended.channels[1].dynamics);
  CHECK(channel.gain == Approx(1.0 + 1.5 * 0.02));
  CHECK(channel.time_constants_s[0] == Approx(10.0 * std::exp(-2.0 * 0.03)));
  CHECK(channel.dead_time_s == Approx(4.0 + 0.5 * 0.1 * 2.0));
  CHECK(extended.output_origin(1) == Approx(level));
  REQUIRE(extended.disturbances.size() == 1);
  CHECK(extended.disturbances[0].size == 0.7);
  CHECK(extended.disturbances[0].onset_s == 1100.0);

  // A CV that is not to be kept has the effect alone; without the effect there is nothing at all.
  const ModelSpec alone = extend(bench.problem, found, {true}, {true, false});
  CHECK(std::get<TransferFunction>(alone.channels[1].dynamics).gain == 1.0);
  CHECK(alone.output_origin(1) == 0.0);
  CHECK(alone.disturbances.size() == 1);
  const ModelSpec nothing = extend(bench.problem, found, {false}, {true, true});
  CHECK(nothing.disturbances.empty());
  CHECK(std::get<TransferFunction>(nothing.channels[1].dynamics).gain == 1.0);
}

// Dead times are in rows of the problem: one row of 2 s is two of a second.
TEST_CASE("what was found is put into the same model at another sample time") {
  const Bench bench;
  const SearchResult found = found_with({&causes::dead_time(), {1, 0}, {{&kDeadTimeError, 1.5}}});
  ModelSpec own = bench.model;
  own.sample_time_s = 1.0;
  own.channels[1].dynamics = DiscreteFilter{{0.1}, {1.0, -0.9}, 4};
  const ModelSpec extended = extend(own, bench.problem, found, {true}, {true, true});
  CHECK(extended.sample_time_s == 1.0);
  CHECK(std::get<DiscreteFilter>(extended.channels[1].dynamics).delay_samples == 7);
}

TEST_CASE("a plant has a stage from where each of what was found begins") {
  const Bench bench;
  SearchResult found = found_with({&causes::gain(), {0, 0}, {{&kGainRatio, 1.3}}, 100});
  found.named.push_back({{&causes::gain(), {1, 0}, {{&kGainRatio, 2.0}}}, 42.0, 0.98, {}});
  const std::vector<Stage> stages = stages_of(bench.problem, found, {true, true}, {true, true});
  const auto gain = [&](std::size_t stage, std::size_t channel) {
    return std::get<TransferFunction>(stages[stage].model.channels[channel].dynamics).gain;
  };
  REQUIRE(stages.size() == 2);
  CHECK(stages[0].first == 0);
  CHECK(gain(0, 0) == 2.0);
  CHECK(gain(0, 1) == 2.0);
  CHECK(stages[1].first == 100);
  CHECK(gain(1, 0) == Approx(2.6));
  CHECK(gain(1, 1) == 2.0);
  CHECK(stages_of(bench.problem, found, {false, true}, {true, true}).size() == 1);
}

// Of two aux signals the second is used: it becomes the input after the model's.
TEST_CASE("aux signals that no channel uses are no inputs of the finished model") {
  const ModelSpec base = Bench::two_cvs();
  Recording recording = Bench().recording;
  recording.aux = MatrixXd::Constant(kRows, 2, 3.0);
  recording.aux.col(1).setConstant(7.0);
  ModelSpec extended = with_aux_inputs(base, recording);
  extended.input_blocks[0] = Deadband{0.1};
  extended.channels.push_back(lag(1, 2, 0.5, 30.0));
  std::vector<int> used = {9};
  const ModelSpec model = finish(extended, base, used);
  CHECK(used == std::vector<int>{1});
  CHECK(model.input_count == 2);
  CHECK(model.input_blocks.size() == 2);
  CHECK(model.input_blocks[0].has_value());
  REQUIRE(model.channels.size() == 3);
  CHECK(model.channels[2].input == 1);
  CHECK(model.input_origin(1) == 7.0);
  const ModelSpec without = finish(with_aux_inputs(base, recording), base, used);
  CHECK(used.empty());
  CHECK(without.input_count == 1);
}

}  // namespace
}  // namespace mpm::extension_test
