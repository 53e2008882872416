#include "core/identify/diagnosis/rejected.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::rejected_test {
namespace {

constexpr Eigen::Index kRows = 900;

ModelSpec model_with(double gain) { return test::model_of({test::lag(0, 0, gain, 10.0)}, 1, 1); }

Recording plant(double gain, double noise = 0.1) {
  const Eigen::VectorXd u = test::telegraph(1, kRows, 12);
  return test::recording_of(u, test::first_order(u, gain, 10.0) +
                                   noise * test::autoregressive(test::white(2, kRows), 0.5));
}

ChannelTests tests_of(double model_gain, const Recording& recording) {
  const ModelSpec model = model_with(model_gain);
  return {model, recording, free_run_residuals(model, recording)};
}

Diagnosis with(const Cause& cause, Place place) {
  Diagnosis diagnosis;
  diagnosis.findings.emplace_back();
  diagnosis.findings.back().subject = {&cause, place};
  return diagnosis;
}

TEST_CASE("a channel that is surely wrong stays until something named is about it") {
  const ChannelTests tests = tests_of(2.0, plant(2.8));
  const auto rejected = [&](const Diagnosis& diagnosis) {
    return !rejected_channels(model_with(2.0), tests, diagnosis).empty();
  };
  CHECK(rejected({}));
  CHECK_FALSE(rejected(with(causes::gain(), {0, 0})));
  CHECK_FALSE(rejected(with(causes::input_scale(), {-1, 0})));
  CHECK_FALSE(rejected(with(causes::output_scale(), {0})));
  // What disturbs the CV says nothing of its channels.
  CHECK(rejected(with(causes::step_disturbance(), {0})));
  CHECK(rejected(with(causes::noise(), {0})));
}

TEST_CASE("what a monitor would alarm of is rejected where nothing is named, and only there") {
  const ChannelTests tests = tests_of(2.0, plant(2.8, 2.0));
  const double p_value = tests.p_value(0, 0).value();
  CAPTURE(p_value, tests.harmless_p_value(0, 0));
  REQUIRE((p_value > 1e-6 && p_value < 0.01));  // neither surely wrong nor a match
  REQUIRE(tests.harmless_p_value(0, 0) < 0.01);
  CHECK(rejected_channels(model_with(2.0), tests, {}).size() == 1);
  CHECK(rejected_channels(model_with(2.0), tests, with(causes::step_disturbance(), {0})).empty());
}

TEST_CASE("no channel that is right or nearly so is rejected, and none that a repair has mended") {
  const Recording recording = plant(2.8);
  CHECK(rejected_channels(model_with(2.8), tests_of(2.8, recording), {}).empty());
  CHECK(rejected_channels(model_with(2.75), tests_of(2.75, recording), {}).empty());
  std::vector<Place> channels = rejected_channels(model_with(2.0), tests_of(2.0, recording), {});
  keep_rejected(tests_of(2.0, recording), channels);
  CHECK(channels.size() == 1);
  keep_rejected(tests_of(2.8, recording), channels);
  CHECK(channels.empty());
}

}  // namespace
}  // namespace mpm::rejected_test
