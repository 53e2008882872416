// What a scenario's `plant:` section hides: the shipped scenarios against the unit's model with the
// hidden thing put around it by hand.
#include "sim/plant/hidden_plant.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/model/static_blocks.hpp"
#include "sim/output/csv_writer.hpp"
#include "sim/output/truth.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/sim/units.hpp"

namespace {

using Eigen::VectorXd;
using mpm::Frame;
using mpm::LinearModel;
using mpm::SignalKind;
using mpm::sim::ClosedLoop;
using mpm::sim::LoopSetup;
using mpm::test::load_plant;

LoopSetup shipped(const std::string& scenario, const std::string& plant = "shell3x3") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant(plant));
  const std::string file = std::string(MPM_SOURCE_DIR) + "/config/scenarios/" + scenario + ".yaml";
  mpm::config::ScenarioResult loaded = mpm::config::load_scenario(file, setup.unit);
  for (const mpm::config::Finding& finding : loaded.findings) FAIL_CHECK(format(finding));
  setup.scenario = loaded.scenario;
  mpm::sim::hide_changes(setup);
  return setup;
}

/// Largest distance of the plant from `expected(u as sent, k)`, taken before u acts; the prediction
/// must be the unit's model alone.
double distance(const LoopSetup& setup, const std::function<VectorXd(const Frame&)>& expected) {
  ClosedLoop loop(setup);
  LinearModel believed(setup.unit.model);
  double largest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const Frame& frame = loop.step();
    largest = std::max(largest, (loop.true_output() - expected(frame)).cwiseAbs().maxCoeff());
    REQUIRE(frame[SignalKind::kPrediction].values == believed.output());
    believed.advance(frame[SignalKind::kMv].values);
  }
  CHECK(loop.finite());
  return largest;
}

/// The unit's model behind inputs that were changed on their way.
class Behind {
 public:
  Behind(const LoopSetup& setup, std::function<void(VectorXd&)> change)
      : model_(mpm::sim::changed_model(setup.unit.model, setup.changes)),
        change_(std::move(change)) {}

  VectorXd operator()(const Frame& frame) {
    VectorXd output = model_.output();
    VectorXd input = frame[SignalKind::kMv].values;
    change_(input);
    model_.advance(input);
    return output;
  }

 private:
  LinearModel model_;
  std::function<void(VectorXd&)> change_;
};

nlohmann::json truth_of(const LoopSetup& setup) {
  return nlohmann::json::parse(mpm::sim::truth_json(setup, ""))["plant"];
}

}  // namespace

TEST_CASE("scenario sticking_valve: u2 goes through a sticking valve") {
  const LoopSetup setup = shipped("sticking_valve");
  mpm::InputElement valve(mpm::InputBlock(mpm::Stiction{0.12, 0.06}), 0.0);
  double stuck = 0.0, last = 1e9;
  CHECK(distance(setup, Behind(setup, [&](VectorXd& u) {
                   u(1) = valve.apply(u(1), 0.0);
                   stuck += u(1) == last ? 1.0 : 0.0;
                   last = u(1);
                 })) < 1e-12);
  CHECK(stuck > 500.0);  // it does stick for much of the run
  CHECK(truth_of(setup)["input"]["u2"]["stiction"] ==
        nlohmann::json::parse(R"({"band": 0.12, "jump": 0.06})"));
}

TEST_CASE("scenario valve_saturation: u1 stops at +-0.9") {
  const LoopSetup setup = shipped("valve_saturation");
  int at_stop = 0;
  CHECK(distance(setup, Behind(setup, [&](VectorXd& u) {
                   at_stop += std::abs(u(0)) > 0.9 ? 1 : 0;
                   u(0) = std::clamp(u(0), -0.9, 0.9);
                 })) < 1e-12);
  CHECK(at_stop > 100);
  CHECK(truth_of(setup)["input"]["u1"]["saturation"] == nlohmann::json::parse("[-0.9, 0.9]"));
}

TEST_CASE("scenario product_of_inputs: what u2 does grows with u3") {
  const LoopSetup setup = shipped("product_of_inputs");
  CHECK(distance(setup, Behind(setup, [](VectorXd& u) { u(1) *= 1.0 + 0.3 * u(2); })) < 1e-12);
  CHECK(truth_of(setup)["input"]["u2"]["product"] ==
        nlohmann::json::parse(R"({"of": "u3", "per_unit": 0.3})"));
}

TEST_CASE("scenario directional_gain: u1 does more above its operating point than below") {
  const LoopSetup setup = shipped("directional_gain");
  CHECK(distance(setup, Behind(setup, [](VectorXd& u) { u(0) *= u(0) < 0.0 ? 0.7 : 1.3; })) <
        1e-12);
}

TEST_CASE("scenario sensor_offset: y2 reads 0.15 more, and the controller holds what it reads") {
  const LoopSetup setup = shipped("sensor_offset");
  Behind behind(setup, [](VectorXd&) {});
  CHECK(distance(setup, [&](const Frame& frame) -> VectorXd {
          return behind(frame) + Eigen::Vector3d(0.0, 0.15, 0.0);
        }) < 1e-12);
  CHECK(truth_of(setup)["output"]["y2"]["offset"] == 0.15);
}

TEST_CASE("scenario unmodelled_input: an aux signal acts on y1, and is reported") {
  const LoopSetup setup = shipped("unmodelled_input", "shell3x3_ambient");
  Behind behind(setup, [](VectorXd&) {});
  // 0.8 e^{-5s} / (30 s + 1) of the aux signal as reported, by its difference equation.
  const double a = std::exp(-1.0 / 30.0);
  std::vector<double> ambient;
  double effect = 0.0, largest = 0.0, other = 0.0;
  CHECK(distance(setup, [&](const Frame& frame) -> VectorXd {
          VectorXd output = behind(frame) + Eigen::Vector3d(effect, 0.0, 0.0);
          ambient.push_back(frame[SignalKind::kAux].values(0));
          const double late = ambient.size() > 5 ? ambient[ambient.size() - 6] : 0.0;
          effect = a * effect + 0.8 * (1.0 - a) * late;
          largest = std::max(largest, std::abs(effect));
          other = std::max(other, std::abs(frame[SignalKind::kAux].values(1)));
          CHECK(frame[SignalKind::kAux].usable(0));
          return output;
        }) < 1e-12);
  CHECK(largest > 0.2);  // the noise has an s.d. of 0.03
  CHECK(other > 0.2);
  const nlohmann::json channel = truth_of(setup)["channels"][0];
  CHECK(channel["mv"] == "t_amb");
  CHECK(channel["cv"] == "y1");
  CHECK(channel["gain"] == 0.8);
}

TEST_CASE("scenario quadratic_valve: the flow is u2 + 0.15 u2^2") {
  const LoopSetup setup = shipped("quadratic_valve");
  CHECK(distance(setup, Behind(setup, [](VectorXd& u) { u(1) += 0.15 * u(1) * u(1); })) < 1e-12);
  CHECK(truth_of(setup)["input"]["u2"]["polynomial"] == nlohmann::json::parse("[1.0, 0.15]"));
}

TEST_CASE("scenario two_causes: play in front of u1 and a gain of 80 %") {
  const LoopSetup setup = shipped("two_causes");
  REQUIRE(setup.changes.size() == 1);
  double position = 0.0;
  CHECK(distance(setup, Behind(setup, [&](VectorXd& u) {
                   position = std::clamp(position, u(0) - 0.1, u(0) + 0.1);
                   u(0) = position;
                 })) < 1e-12);
  CHECK(truth_of(setup)["input"]["u1"]["deadband"] == 0.2);
  CHECK(nlohmann::json::parse(mpm::sim::truth_json(setup, ""))["changes"][0]["gain_ratio"] == 0.8);
}

TEST_CASE("signals that move beside the model have their columns, and only those") {
  mpm::config::UnitConfig unit = load_plant("shell3x3_ambient");
  const auto header = [&unit] {
    std::ostringstream out;
    const mpm::sim::CsvWriter csv(out, unit, 0.0);
    return out.str();
  };
  CHECK(header() == "time,sp1,sp2,sp3,u1,u2,u3,y1,y2,y3,yhat1,yhat2,yhat3,t_amb,p_atm\n");
  unit.simulation.aux_movement[0].sigma = 0.0;
  CHECK(header() == "time,sp1,sp2,sp3,u1,u2,u3,y1,y2,y3,yhat1,yhat2,yhat3,p_atm\n");
}

TEST_CASE("aux signals shift no other number of the run") {
  LoopSetup with = mpm::test::healthy_loop(load_plant("shell3x3_ambient"));
  ClosedLoop loop(with), plain(mpm::test::healthy_loop(load_plant("shell3x3")));
  for (int k = 0; k < 300; ++k)
    REQUIRE(loop.step()[SignalKind::kCv].values == plain.step()[SignalKind::kCv].values);
}

TEST_CASE("hidden blocks and channels stand in place of the model's own") {
  mpm::config::UnitConfig unit = load_plant("shell3x3");
  unit.model.input_blocks[0] = mpm::Deadband{0.1};
  mpm::config::HiddenPlant hidden;
  CHECK(mpm::sim::plant_model(unit, hidden).channels.size() == 9);
  hidden.input_blocks.resize(3);
  hidden.input_blocks[0] = mpm::Saturation{-1.0, 1.0};
  hidden.channels.push_back({0, 1, mpm::TransferFunction{3.0, {10.0}, 0.0, 0.0, false}});
  hidden.state_terms.push_back({0, 1, mpm::RestoringForce{0.0, 0.1}});
  const mpm::ModelSpec plant = mpm::sim::plant_model(unit, hidden);
  CHECK(std::holds_alternative<mpm::Saturation>(*plant.input_blocks[0]));
  REQUIRE(plant.channels.size() == 9);
  CHECK(LinearModel(plant).steady_gain()(0, 1) == 3.0);
  CHECK(LinearModel(plant).steady_gain()(1, 1) == 5.72);
  CHECK(plant.input_count == 3);
}

TEST_CASE("a hidden channel that no offset-free controller can bear is refused at its place") {
  LoopSetup setup = mpm::test::healthy_loop(load_plant("shell3x3"));
  mpm::config::ScenarioResult loaded = mpm::config::load_scenario_text(
      "plant:\n  channels: {cv: y3, mv: u3, gain: -7, time_constants: 19}\n", "s.yaml", setup.unit);
  REQUIRE(loaded.ok());
  setup.scenario = loaded.scenario;
  try {
    mpm::sim::hide_changes(setup);
    FAIL("not refused");
  } catch (const mpm::sim::RefusedScenario& error) {
    CHECK(format(error.finding()).rfind("s.yaml:2:3: error: plant: no offset-free", 0) == 0);
  }
}

TEST_CASE("a loop with hidden elements does not allocate") {
  const LoopSetup setup = shipped("unmodelled_input", "shell3x3_ambient");
  ClosedLoop loop(setup);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 300; ++k) static_cast<void>(loop.step());
  CHECK(mpm::test::allocation_count() == before);
}
