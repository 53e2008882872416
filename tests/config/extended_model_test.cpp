// What an extended model holds beside linear channels: channel blocks, tanks, state terms and
// disturbances.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "core/model/linear_model.hpp"
#include "tests/config/extended_unit.hpp"

namespace extended_model_test {

using namespace mpm;
using namespace mpm::config;
using mpm::test::kExtendedUnit;

namespace {

UnitConfig load_clean(const std::string& text) {
  const LoadResult result = load_unit_text(text, "u.yaml");
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  return result.config;
}

std::string printed(const UnitConfig& config) {
  std::ostringstream out;
  print_unit(config, out);
  return out.str();
}

void check_full(const UnitConfig& config) {
  const ModelSpec& model = config.model;
  REQUIRE(model.channels.size() == 5);
  const auto& tanks = std::get<TankChain>(model.channels[0].dynamics);
  CHECK(tanks.time_constants_s == std::vector<double>{20, 35});
  CHECK(tanks.empty_input == 10);
  CHECK(tanks.empty_output == 20);
  REQUIRE(tanks.overflow.size() == 2);
  CHECK(tanks.overflow[0] == 1.5);
  CHECK(std::isinf(tanks.overflow[1]));
  CHECK(tanks.spill == 0.25);
  CHECK(tanks.dead_time_s == 3.5);
  CHECK(std::get<Deadband>(model.channels[0].input_block.value()).width == 0.5);
  CHECK(std::get<Polynomial>(model.channels[1].input_block.value()).coefficients ==
        std::vector<double>{1, 0.25});
  CHECK(std::get<Saturation>(model.channels[2].input_block.value()).high == 60);
  CHECK(std::get<Stiction>(model.channels[3].input_block.value()).jump == 1);
  CHECK(std::get<Stiction>(model.channels[3].input_block.value()).slips_once);
  CHECK_FALSE(model.channels[4].input_block.has_value());

  REQUIRE(model.state_terms.size() == 3);
  CHECK(model.state_terms[0].cv == 1);
  CHECK(model.state_terms[0].input == 0);
  CHECK(std::get<RestoringForce>(model.state_terms[0].block).quadratic == 0.125);
  CHECK(std::get<RestoringForce>(model.state_terms[0].block).cubic == -0.5);
  CHECK(std::get<SquareRootOutflow>(model.state_terms[1].block).empty_output == 5);
  CHECK(model.state_terms[2].input == 2);
  CHECK(std::get<CoulombFriction>(model.state_terms[2].block).force == 0.75);
  CHECK(std::get<CoulombFriction>(model.state_terms[2].block).speed == 0.01);

  REQUIRE(model.disturbances.size() == 4);
  const DisturbanceTerm& step = model.disturbances[0];
  CHECK(step.shape == DisturbanceShape::kStep);
  CHECK(step.onset_s == 1709294400.25);  // date -u -d 2024-03-01T12:00:00Z +%s = 1709294400
  CHECK(step.until_s == 1709380800.0);
  CHECK(step.size == -2);
  CHECK(step.time_constant_s == 30);
  CHECK(model.disturbances[1].shape == DisturbanceShape::kDrift);
  CHECK(model.disturbances[1].cv == 1);
  CHECK(model.disturbances[1].onset_s == -100.5);
  CHECK(model.disturbances[1].size == 1e-4);
  CHECK(model.disturbances[1].until_s == 1e6);
  CHECK(model.disturbances[2].shape == DisturbanceShape::kPeriodic);
  CHECK(model.disturbances[2].period_s == 70);
  CHECK(model.disturbances[2].onset_s == 7);
  CHECK(model.disturbances[2].square);
  CHECK(std::isinf(step.decay_s));
  CHECK(std::isinf(model.disturbances[3].until_s));
  CHECK(model.disturbances[3].decay_s == 600);
  REQUIRE(config.simulation.aux_movement.size() == 2);
  CHECK(config.simulation.aux_movement[0].sigma == 0);
  CHECK(config.simulation.aux_movement[1].sigma == 0.2);
  CHECK(config.simulation.aux_movement[1].pole == 0.98);
  CHECK_NOTHROW(LinearModel(model));
}

}  // namespace

TEST_CASE("every key of an extended model arrives and survives printing") {
  const UnitConfig config = load_clean(kExtendedUnit);
  check_full(config);
  const std::string once = printed(config);
  const UnitConfig again = load_clean(once);
  check_full(again);
  CHECK(printed(again) == once);
}

TEST_CASE("a stuck and an offset input survive printing, with an onset and without") {
  const UnitConfig config = load_clean(
      "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2, u3, u4], cv: y1}\n"
      "model:\n"
      "  channels: [{cv: y1, mv: u1, gain: 1, input: {offset: -1.5}}, {cv: y1, mv: u2, gain: 1}]\n"
      "  input:\n"
      "    u1: {stuck: 40}\n"
      "    u2: {stuck: {value: 50.5, onset: 2024-03-01T12:00:00Z}}\n"
      "    u3: {offset: {size: 3, onset: 12.25}}\n"
      "    u4: {offset: {size: -3}}\n");
  const std::string once = printed(config);
  const UnitConfig again = load_clean(once);
  CHECK(printed(again) == once);
  for (const ModelSpec& model : {config.model, again.model}) {
    const auto always = -std::numeric_limits<double>::infinity();
    CHECK(std::get<InputOffset>(model.channels[0].input_block.value()).size == -1.5);
    CHECK(std::get<Stuck>(model.input_blocks[0].value()).value == 40);
    CHECK(std::get<Stuck>(model.input_blocks[0].value()).onset_s == always);
    CHECK(std::get<Stuck>(model.input_blocks[1].value()).value == 50.5);
    CHECK(std::get<Stuck>(model.input_blocks[1].value()).onset_s == 1709294400.0);
    CHECK(std::get<InputOffset>(model.input_blocks[2].value()).size == 3);
    CHECK(std::get<InputOffset>(model.input_blocks[2].value()).onset_s == 12.25);
    CHECK(std::get<InputOffset>(model.input_blocks[3].value()).size == -3);
    CHECK(std::get<InputOffset>(model.input_blocks[3].value()).onset_s == always);
  }
}

TEST_CASE("what an input does on either side of a point survives printing") {
  const UnitConfig config = load_clean(
      "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2], cv: y1}\n"
      "model:\n"
      "  channels: [{cv: y1, mv: u1, gain: 1}, {cv: y1, mv: u2, gain: 1}]\n"
      "  input:\n"
      "    u1: {two_sided: {above: 1.3, below: 0.7, at: 40}}\n"
      "    u2: {two_sided: {below: 0.5}}\n");
  const std::string once = printed(config);
  const UnitConfig again = load_clean(once);
  CHECK(printed(again) == once);
  for (const ModelSpec& model : {config.model, again.model}) {
    const auto& heating = std::get<TwoSided>(model.input_blocks[0].value());
    CHECK(heating.above == 1.3);
    CHECK(heating.below == 0.7);
    CHECK(heating.at == 40.0);
    const auto& half = std::get<TwoSided>(model.input_blocks[1].value());
    CHECK(half.above == 1.0);
    CHECK(half.below == 0.5);
    CHECK(std::isnan(half.at));
  }
}

TEST_CASE("what goes with another input survives printing") {
  const UnitConfig config = load_clean(
      "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2], dv: d1, cv: y1}\n"
      "model:\n"
      "  channels:\n"
      "    - {cv: y1, mv: u1, gain: 1}\n"
      "    - {cv: y1, mv: u2, gain: 1, input: {product: {of: d1, per_unit: -2, linear: 0.9}}}\n"
      "  input:\n"
      "    u1: {product: {of: u2, per_unit: 0.3}}\n");
  const std::string once = printed(config);
  const UnitConfig again = load_clean(once);
  CHECK(printed(again) == once);
  for (const ModelSpec& model : {config.model, again.model}) {
    const auto& valves = std::get<Product>(model.input_blocks[0].value());
    CHECK(valves.of == 1);
    CHECK(valves.per_unit == 0.3);
    CHECK(valves.linear == 1.0);
    const auto& own = std::get<Product>(model.channels[1].input_block.value());
    CHECK(own.of == 2);
    CHECK(own.per_unit == -2.0);
    CHECK(own.linear == 0.9);
  }
}

TEST_CASE("the operating point below the channels counts for tanks all the same") {
  const UnitConfig config = load_clean(
      "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: y1}\n"
      "model:\n"
      "  channels: {cv: y1, mv: u1, tanks: {time_constants: 5, empty_input: 0, empty_output: 0}}\n"
      "  operating_point: {u1: 1, y1: 2}\n");
  CHECK(LinearModel(config.model).steady_gain()(0, 0) == 4.0);  // 2 x 2 / 1
}

TEST_CASE("a model of disturbances beside a state space loads") {
  const UnitConfig config = load_clean(
      "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: y1}\n"
      "model:\n"
      "  state_space: {A: [[0.5]], B: [[1]], C: [[1]]}\n"
      "  disturbances: {cv: y1, shape: step, onset: 3, size: 1}\n");
  CHECK(config.model.disturbances.size() == 1);
  CHECK(load_clean(printed(config)).model.disturbances.size() == 1);
}

TEST_CASE("every mistake in an extended model is told at its place") {
  // `@` stands where the finding points to.
  struct Case {
    std::string text;  ///< below the head, from line 6
    std::string finding;
  };
  const std::string head =
      "unit: t\nsample_time: 2\n"
      "signals: {mv: [u1, u2], dv: [d1], cv: [{tag: y1, prediction: p1}, {tag: y2, prediction: "
      "p2}], aux: [t_amb, p_atm]}\n"
      "operating_point: {u1: 40, y1: 50, y2: 10}\nmodel:\n";
  const std::string channels =
      "  channels: [{cv: y1, mv: u1, gain: 2}, {cv: y2, mv: u2, gain: 1}]\n";
  const auto with_block = [](const std::string& block) {
    return "  channels: [{cv: y1, mv: u1, gain: 2, input: " + block +
           "}, {cv: y2, mv: u2, gain: 1}]\n";
  };
  const auto tanks = [](const std::string& keys) {
    return "  channels:\n    - {cv: y2, mv: u1, gain: 1}\n    - {cv: y1, mv: u1, tanks: " + keys +
           "}\n";
  };
  const auto state = [&channels](const std::string& terms) {
    return channels + "  state: " + terms + "\n";
  };
  const auto disturbed = [&channels](const std::string& disturbance) {
    return channels + "  disturbances: [" + disturbance + "]\n";
  };
  const std::string sound = "time_constants: [5, 6], empty_input: 10, empty_output: 20";
  const std::string at_rest = ": nothing flows there, so there is nothing to be linear about";
  const std::vector<Case> cases = {
      {with_block("{@deadbnd: 1}"),
       "model.channels[0].input.deadbnd: unknown key (did you mean 'deadband'?)"},
      {with_block("@{deadband: 1, polynomial: 1}"),
       "model.channels[0].input: takes one block only"},
      {with_block("{stuck: @{onset: 3}}"), "model.channels[0].input.stuck: `value` is missing"},
      {with_block("{offset: {size: 1, onset: @soon}}"),
       "model.channels[0].input.offset.onset: must be a number, not 'soon'"},
      {with_block("{saturation: @[3, 1]}"),
       "model.channels[0].input.saturation: low must be below high, not [3, 1]"},
      {tanks("{time_constants: [5, @0], empty_input: 10, empty_output: 20}"),
       "model.channels[1].tanks.time_constants[1]: must be > 0, not 0"},
      {tanks("@{empty_input: 10, empty_output: 20}"),
       "model.channels[1].tanks: `time_constants` is missing"},
      {tanks("@{time_constants: 5, empty_output: 20}"),
       "model.channels[1].tanks: `empty_input` is missing"},
      {tanks("{time_constants: 5, empty_input: @40, empty_output: 20}"),
       "model.channels[1].tanks.empty_input: is the operating point of u1 (40)" + at_rest},
      {tanks("{time_constants: 5, empty_input: 0, empty_output: @50}"),
       "model.channels[1].tanks.empty_output: is the operating point of y1 (50)" + at_rest},
      {tanks("{" + sound + ", overflow: @[2]}"),
       "model.channels[1].tanks.overflow: needs one level per tank (2; .inf = never)"},
      {tanks("{" + sound + ", overflow: [2, @1]}"),
       "model.channels[1].tanks.overflow[1]: must be > 1, not 1"},
      {tanks("{" + sound + ", spill: @2}"),
       "model.channels[1].tanks.spill: must be >= 0 and <= 1, not 2"},
      {tanks("{" + sound + ", @gain: 2}"),
       "model.channels[1].tanks.gain: unknown key (known: time_constants, empty_input, "
       "empty_output, overflow, spill, dead_time)"},
      {"  channels: [{cv: y1, mv: u1, @gain: 2, tanks: {" + sound +
           "}}, {cv: y2, mv: u2, gain: 1}]\n",
       "model.channels[0].gain: does not go with `tanks` in one channel"},
      {state("[{cv: y1, mv: u1, restoring_force: {cubic: 1}, @restorng_force: {cubic: 1}}]"),
       "model.state[0].restorng_force: unknown key (did you mean 'restoring_force'?)"},
      {state("[@{cv: y1, mv: u1}]"),
       "model.state[0]: needs `restoring_force`, `square_root_outflow` or `coulomb_friction`"},
      {state("[{cv: y1, mv: u1, restoring_force: @{}}]"),
       "model.state[0].restoring_force: give `quadratic`, `cubic` or both"},
      {state("[@{cv: y1, mv: u2, restoring_force: {cubic: 1}}]"),
       "model.state[0]: there is no channel from 'u2' to 'y1' for it to act in"},
      {state("[{cv: y1, mv: u1, restoring_force: {cubic: 1}}, @{cv: y1, mv: u1, "
             "coulomb_friction: {force: 1, speed: 1}}]"),
       "model.state[1]: a second term in this channel"},
      {state("[{cv: y1, mv: u1, restoring_force: {cubic: 1}, @coulomb_friction: {force: 1, "
             "speed: 1}}]"),
       "model.state[0].coulomb_friction: does not go with `restoring_force` in one term"},
      {state("[{cv: y1, mv: u1, coulomb_friction: @{force: 1}}]"),
       "model.state[0].coulomb_friction: `speed` is missing"},
      {state("[{cv: y1, mv: u1, coulomb_friction: {force: @-1, speed: 1}}]"),
       "model.state[0].coulomb_friction.force: must be >= 0, not -1"},
      {state("[@{cv: y1, mv: u1, square_root_outflow: {empty_output: 50}}]"),
       "model.state[0]: square root outflow: empty at the operating point"},
      {tanks("{" + sound + "}") + "  state: [@{cv: y1, mv: u1, restoring_force: {cubic: 1}}]\n",
       "model.state[0]: state term: tanks have their own outflow"},
      {"  state_space: {A: [[0.5]], B: [[1, 1, 1]], C: [[1], [1]]}\n"
       "  state: @[{cv: y1, mv: u1, restoring_force: {cubic: 1}}]\n",
       "model.state: goes with `channels`, not with `state_space`"},
      {disturbed("{cv: y1, shape: @ramp, onset: 1, size: 2}"),
       "model.disturbances[0].shape: must be step, drift or periodic"},
      {disturbed("@{cv: y1, onset: 1, size: 2}"), "model.disturbances[0]: `shape` is missing"},
      {disturbed("@{cv: y1, shape: step, size: 2}"), "model.disturbances[0]: `onset` is missing"},
      {disturbed("{cv: @y3, shape: step, onset: 1, size: 2}"),
       "model.disturbances[0].cv: 'y3' is no cv of this unit (did you mean 'y1'?)"},
      {disturbed("{cv: y1, shape: step, onset: 5, size: 2, until: @5}"),
       "model.disturbances[0].until: must be after `onset`"},
      {disturbed("{cv: y1, shape: drift, onset: 1, size: 2, @decay: 5}"),
       "model.disturbances[0].decay: does not go with the shape drift"},
      {disturbed("{cv: y1, shape: step, onset: 1, size: 2, decay: @0}"),
       "model.disturbances[0].decay: must be > 0, not 0"},
      {disturbed("{cv: y1, shape: drift, onset: 1, size: 2, @period: 5}"),
       "model.disturbances[0].period: does not go with the shape drift"},
      {disturbed("@{cv: y1, shape: periodic, size: 2}"),
       "model.disturbances[0]: `period` is missing"},
      {disturbed("{cv: y1, shape: step, onset: @2024-03-01T12:00, size: 2}"),
       "model.disturbances[0].onset: must be seconds or ISO 8601 with a zone, such as "
       "2024-05-01T12:00:00Z, not '2024-03-01T12:00'"},
      {disturbed("{cv: y1, shape: step, onset: @soon, size: 2}"),
       "model.disturbances[0].onset: must be a number, not 'soon'"},
      {disturbed("{cv: y1, shape: periodic, size: 2, period: 9, wave: @saw}"),
       "model.disturbances[0].wave: must be sine or square"},
      {disturbed("{cv: y1, shape: step, onset: 1, size: 2, @wave: square}"),
       "model.disturbances[0].wave: does not go with the shape step"},
      {disturbed("{cv: y1, shape: step, onset: 1, size: 2, @foo: 3}"),
       "model.disturbances[0].foo: unknown key (known: cv, shape, onset, size, time_constant, "
       "decay, "
       "period, wave, until)"},
      {channels + "simulation: {aux_movement: {@t_am: {sigma: 1}}}\n",
       "simulation.aux_movement.t_am: unknown tag or key (did you mean 't_amb'?)"},
  };
  for (const Case& each : cases) {
    std::string text = head + each.text;
    const std::size_t at = text.find('@');
    REQUIRE(at != std::string::npos);
    text.erase(at, 1);
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    const std::size_t column = at - text.rfind('\n', at);
    std::string found;
    for (const Finding& finding : load_unit_text(text, "u.yaml").findings)
      found += format(finding) + "\n";
    INFO(each.text);
    CHECK(found == "u.yaml:" + std::to_string(line + 1) + ":" + std::to_string(column) +
                       ": error: " + each.finding + "\n");
  }
}

}  // namespace extended_model_test
