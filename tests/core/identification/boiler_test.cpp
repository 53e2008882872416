#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "config/scenario_config.hpp"
#include "core/identification/identification.hpp"
#include "core/model/linear_model.hpp"
#include "sim/loop/closed_loop.hpp"
#include "tests/core/oracle.hpp"
#include "tests/sim/units.hpp"

// Expected numbers: tests/oracles/boiler_identification.py, scipy's least squares of the same rows.
namespace mpm::test::boiler_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 5400;  // 15 h
const std::vector<std::string> kCvs = {"FI-500.PV", "TI-502.PV", "AI-601.PV", "AI-602.PV"};
const std::vector<std::string> kMvs = {"FC-301.SP", "FC-101.SP", "TC-102.SP", "HV-501.SP"};

int place_of(const std::vector<std::string>& tags, const std::string& tag) {
  return static_cast<int>(std::find(tags.begin(), tags.end(), tag) - tags.begin());
}

config::ScenarioConfig the_test(const config::UnitConfig& unit) {
  config::ScenarioResult loaded = config::load_scenario(
      std::string(MPM_SOURCE_DIR) + "/config/plants/scenarios/identification.yaml", unit,
      unit.sample_time_s * static_cast<double>(kRows));
  REQUIRE(loaded.findings.empty());
  return std::move(loaded.scenario);
}

/// What `mpmsim --scenario identification --samples 5400 --seed 1` writes.
Recording recorded_test() {
  sim::LoopSetup setup = healthy_loop(load_plant("recovery_boiler"), 1);
  setup.scenario = the_test(setup.unit);
  sim::ClosedLoop loop(setup);
  Recording recording;
  recording.sample_time_s = setup.unit.sample_time_s;
  recording.inputs.resize(kRows, 4);
  recording.cvs.resize(kRows, 4);
  recording.aux.resize(kRows, 0);
  for (Index k = 0; k < kRows; ++k) {
    const Frame& frame = loop.step();
    recording.inputs.row(k) = frame[SignalKind::kMv].values.transpose();
    recording.cvs.row(k) = frame[SignalKind::kCv].values.transpose();
  }
  return recording;
}

/// The plant's own answers of all CVs to a unit step of an MV, with loops and sensors: half the
/// difference of a step up and one down, each of the test's size, without noise.
MatrixXd own_steps(const config::TestSignal& test, Index rows) {
  sim::LoopSetup setup = healthy_loop(without_noise(load_plant("recovery_boiler")), 1);
  MatrixXd answers = MatrixXd::Zero(rows, 4);
  for (const double sign : {1.0, -1.0}) {
    config::TestSignal step = test;
    step.size = sign * test.size;
    step.hold_s = 2.0 * setup.unit.sample_time_s * static_cast<double>(rows);
    step.random = false;
    setup.scenario.tests = {step};
    sim::ClosedLoop loop(setup);
    for (Index k = 0; k < rows; ++k)
      answers.row(k) += loop.step()[SignalKind::kCv].values.transpose() * sign / (2.0 * test.size);
  }
  return answers;
}

VectorXd step_of(const ModelSpec& model, int cv, int input, Index rows) {
  VectorXd step = LinearModel(model).impulse_response(cv, input, static_cast<int>(rows));
  for (Index k = 1; k < rows; ++k) step(k) += step(k - 1);
  return step;
}

/// Of the oracle's step responses of some CVs after 50, 100 and 200 samples: how many there are,
/// and how many of `step(cv, input, sample)` are more than 1.96 s.d. from them.
struct Beyond {
  int of = 0, count = 0;
};
template <class Step>
Beyond beyond(const std::vector<std::string>& cvs, const Step& step) {
  const nlohmann::json oracle = read_oracle("boiler_identification.json");
  Beyond result;
  for (const auto& channel : oracle["channels"]) {
    const std::string cv = channel["cv"], mv = channel["mv"];
    if (std::find(cvs.begin(), cvs.end(), cv) == cvs.end()) continue;
    for (std::size_t i = 0; i < oracle["lags"].size(); ++i) {
      const double value = step(place_of(kCvs, cv), place_of(kMvs, mv), Index(oracle["lags"][i]));
      const double expected = channel["steps"][i], sd = channel["step_sd"][i];
      ++result.of;
      if (std::abs(value - expected) <= 1.96 * sd) continue;
      ++result.count;
      UNSCOPED_INFO(mv << " to " << cv << " after " << oracle["lags"][i] << ": " << value
                       << ", oracle " << expected << ", s.d. " << sd);
    }
  }
  return result;
}

/// Of n independent numbers in their 95 % intervals more are beyond once in 300 times (binomial).
/// Those of one channel go together, so that it is more often than that; but oracle and
/// identification read the same rows, and differ by less than either errs.
constexpr int kMostBeyondOf12 = 3, kMostBeyondOf21 = 4, kMostBeyondOf30 = 5;

Beyond identified_beyond(const ModelSpec& model, const std::vector<std::string>& cvs) {
  return beyond(cvs, [&](int cv, int input, Index sample) {
    return step_of(model, cv, input, sample + 1)(sample);
  });
}

TEST_CASE("the boiler's channels are the oracle's, and all but steam flow answer as there",
          "[trials]") {
  const Identification found = identify(recorded_test(), {{}, 2});
  std::vector<std::pair<int, int>> expected, identified;
  const nlohmann::json oracle = read_oracle("boiler_identification.json");
  for (const auto& channel : oracle["channels"])
    expected.emplace_back(place_of(kCvs, channel["cv"]), place_of(kMvs, channel["mv"]));
  for (const ChannelSpec& channel : found.model.channels)
    identified.emplace_back(channel.cv, channel.input);
  CHECK(expected.size() == 14);
  CHECK(identified == expected);
  const Beyond result = identified_beyond(found.model, {"TI-502.PV", "AI-601.PV", "AI-602.PV"});
  CHECK(result.of == 30);
  CHECK(result.count <= kMostBeyondOf30);
}

// The identified model of steam flow lacks slow parts that the oracle finds, and its intervals do
// not say so (docs/recovery_boiler.md). Whoever mends that is told by this test.
TEST_CASE("steam flow answers as the oracle says", "[trials][!shouldfail]") {
  Recording recording = recorded_test();
  recording.cvs = recording.cvs.leftCols(1).eval();
  const Identification found = identify(recording, {{}, 2});
  const Beyond result = identified_beyond(found.model, {"FI-500.PV"});
  CHECK(result.count <= kMostBeyondOf12);
}

TEST_CASE("the plant's own steps of steam flow and O2 are those of the oracle") {
  const config::UnitConfig unit = load_plant("recovery_boiler");
  const config::ScenarioConfig test = the_test(unit);
  std::vector<MatrixXd> steps(kMvs.size());
  for (const config::TestSignal& each : test.tests)
    steps[static_cast<std::size_t>(place_of(kMvs, each.mv))] = own_steps(each, 201);
  const Beyond result = beyond({"FI-500.PV", "AI-601.PV"}, [&](int cv, int input, Index sample) {
    return steps[static_cast<std::size_t>(input)](sample, cv);
  });
  CHECK(result.of == 21);
  CHECK(result.count <= kMostBeyondOf21);
}

}  // namespace
}  // namespace mpm::test::boiler_test
