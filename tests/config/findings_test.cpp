#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "config/load_unit.hpp"

using mpm::config::load_unit_text;

namespace {

std::vector<std::string> findings_of(const std::string& text) {
  std::vector<std::string> lines;
  for (const auto& finding : load_unit_text(text, "u.yaml").findings)
    lines.push_back(format(finding));
  return lines;
}

// Lines 1 to 5 of a sound file; what a case adds begins in line 6.
const std::string kHead =
    "unit: t\n"
    "sample_time: 2\n"
    "signals:\n"
    "  mv: [u1, u2]\n"
    "  cv: [{tag: y1, prediction: p1}]\n";
const std::string kModel =
    "model:\n"
    "  channels: [{cv: y1, mv: u1, gain: 2}]\n";

std::vector<std::string> findings_below(const std::string& text) {
  return findings_of(kHead + text);
}

struct Case {
  std::string text;  ///< below kHead
  std::string finding;
};

const std::string kKnownRoot =
    "unit, sample_time, signals, model, operating_point, monitor, alarms, dds, simulation, "
    "identify";

}  // namespace

TEST_CASE("A sound file has no findings") { CHECK(findings_below(kModel).empty()); }

TEST_CASE("Every mistake in a section is told at its place") {
  const auto [text, finding] = GENERATE(values<Case>({
      // Sections
      {kModel + "monitr: {}\n", "u.yaml:8:1: error: monitr: unknown key (did you mean 'monitor'?)"},
      {kModel + "wibble: {}\n",
       "u.yaml:8:1: error: wibble: unknown key (known: " + kKnownRoot + ")"},
      {kModel + "monitor: 3\n", "u.yaml:8:10: error: monitor: must be a map of keys, not '3'"},
      {kModel + "monitor: {}\nmonitor: {}\n",
       "u.yaml:9:1: error: monitor: given twice; first in line 8"},
      // Channels
      {"model:\n  channels: [{cv: y2, mv: u1, gain: 2}, {cv: y1, mv: u1, gain: 2}]\n",
       "u.yaml:7:19: error: model.channels[0].cv: 'y2' is no cv of this unit (did you mean 'y1'?)"},
      {"model:\n  channels: [{cv: y1, mv: y1, gain: 2}, {cv: y1, mv: u1, gain: 2}]\n",
       "u.yaml:7:27: error: model.channels[0].mv: 'y1' is no mv or dv of this unit (did you mean "
       "'u1'?)"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2}, {cv: y1, mv: u1, gain: 3}]\n",
       "u.yaml:7:41: error: model.channels[1]: a second channel from 'u1' to 'y1'; the first is in "
       "line 7"},
      {"model:\n  channels: [{cv: y1, mv: u1, dv: u2, gain: 2}]\n",
       "u.yaml:7:35: error: model.channels[0].dv: give either `mv` or `dv`, not both"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 4,05}]\n",
       "u.yaml:7:39: error: model.channels[0].05: unknown key; a number has a decimal point, not a "
       "comma"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: .nan}]\n",
       "u.yaml:7:37: error: model.channels[0].gain: must be a finite number, not '.nan'"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: inf}]\n",
       "u.yaml:7:37: error: model.channels[0].gain: must be a finite number, not 'inf'"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 1e999}]\n",
       "u.yaml:7:37: error: model.channels[0].gain: must be a finite number, not '1e999'"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: [2]}]\n",
       "u.yaml:7:37: error: model.channels[0].gain: must be a number, not a list"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain:}]\n",
       "u.yaml:7:31: error: model.channels[0].gain: must be a number, not nothing"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 0}]\n",
       "u.yaml:7:37: warning: model.channels[0].gain: a channel of gain 0 does nothing"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, time_constants: [5, 0]}]\n",
       "u.yaml:7:60: error: model.channels[0].time_constants[1]: must be > 0, not 0"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, time_constants: -5}]\n",
       "u.yaml:7:56: error: model.channels[0].time_constants: must be > 0, not -5"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, dead_time: -1}]\n",
       "u.yaml:7:51: error: model.channels[0].dead_time: must be >= 0, not -1"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, dead_time: 1e6}]\n",
       "u.yaml:7:51: error: model.channels[0].dead_time: is longer than 100000 samples"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, lead: 3}]\n",
       "u.yaml:7:46: error: model.channels[0].lead: a channel with a lead needs a time constant"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2, integrating: perhaps}]\n",
       "u.yaml:7:53: error: model.channels[0].integrating: must be true or false, not 'perhaps'"},
      {"model:\n  channels: [{cv: y1, mv: u1, numerator: 1, denominator: [0, 1]}]\n",
       "u.yaml:7:58: error: model.channels[0].denominator: must not begin with 0"},
      {"model:\n  channels: [{cv: y1, mv: u1, numerator: 1, denominator: [1, -1.5]}]\n",
       "u.yaml:7:58: warning: model.channels[0].denominator: is unstable: a pole at |z| = 1.5"},
      {"model:\n  channels: [{cv: y1, mv: u1, numerator: [], denominator: [1]}]\n",
       "u.yaml:7:42: error: model.channels[0].numerator: must not be empty"},
      {"model:\n  channels: [{cv: y1, mv: u1, numerator: 1, delay_samples: 1.5}]\n",
       "u.yaml:7:60: error: model.channels[0].delay_samples: must be a whole number, not '1.5'"},
      {"model:\n  channels: [{cv: y1, mv: u1, step_response: []}]\n",
       "u.yaml:7:46: error: model.channels[0].step_response: must not be empty"},
      {"model:\n  channels: [{cv: y1, mv: u1, step_response: [0, 1], gain: 3}]\n",
       "u.yaml:7:54: error: model.channels[0].gain: does not go with `step_response` in one "
       "channel"},
      {"model:\n  channels: [{cv: y1, mv: u1}]\n",
       "u.yaml:7:14: error: model.channels[0]: needs `gain`, `numerator`, `step_response` or "
       "`tanks`"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2}, wibble]\n",
       "u.yaml:7:41: error: model.channels[1]: a channel is a map such as {cv: y1, mv: u1, gain: "
       "2}"},
      // State space: 2 inputs, 1 CV
      {"model:\n  state_space: {A: [[0.5, 0]], B: [[1, 1]], C: [[1]]}\n",
       "u.yaml:7:20: error: model.state_space.A: must be 1 x 1 (square), not 1 x 2"},
      {"model:\n  state_space: {A: 0.5, B: [[1]], C: 1}\n",
       "u.yaml:7:28: error: model.state_space.B: must be 1 x 2 (states x MVs and DVs), not 1 x 1"},
      {"model:\n  state_space: {A: 0.5, B: [[1, 2]], C: [[1, 2]]}\n",
       "u.yaml:7:41: error: model.state_space.C: must be 1 x 1 (CVs x states), not 1 x 2"},
      {"model:\n  state_space: {A: 0.5, B: [[1, 2]], C: 1, D: [[1]]}\n",
       "u.yaml:7:47: error: model.state_space.D: must be 1 x 2 (CVs x MVs and DVs), not 1 x 1"},
      {"model:\n  state_space: {A: 0.5, B: [[1, 2]], C: 1, x0: [1, 2]}\n",
       "u.yaml:7:48: error: model.state_space.x0: must have 1 number, one per state"},
      {"model:\n  state_space: {A: [[1, 0], [1]], B: [[1, 2], [1, 2]], C: [[1, 0]]}\n",
       "u.yaml:7:29: error: model.state_space.A[1]: this row has 1 number, the first one 2"},
      {"model:\n  state_space: {A: -1.05, B: [[1, 2]], C: 1}\n",
       "u.yaml:7:20: warning: model.state_space.A: is unstable: an eigenvalue at |z| = 1.05"},
      {"model:\n  state_space: {A: 1.5, B: [[1, 2]], C: 1}\n",
       "u.yaml:7:20: error: model.state_space.A: has a response that no number can hold within "
       "5000 "
       "samples"},
      {"model:\n  state_space: {A: 0.5, B: [[1e308, 2]], C: 1}\n",
       "u.yaml:7:30: error: model.state_space.B[0][0]: must be between -1e30 and 1e30, in whatever "
       "unit, not 1e+308"},
      {"model:\n  state_space: {A: 0.5, B: [[1, 2]]}\n",
       "u.yaml:7:16: error: model.state_space: `C` is missing"},
      {"model:\n  channels: [{cv: y1, mv: u1, gain: 2}]\n  state_space: {A: 0, B: [[1, 2]], C: "
       "1}\n",
       "u.yaml:8:16: error: model.state_space: give either `channels` or `state_space`, not both"},
      // Static blocks and operating point
      {kModel + "  input: {u3: {deadband: 1}}\n",
       "u.yaml:8:11: error: model.input.u3: unknown tag (did you mean 'u1'?)"},
      {kModel + "  input: {u1: {saturation: [2, 1]}}\n",
       "u.yaml:8:28: error: model.input.u1.saturation: low must be below high, not [2, 1]"},
      {kModel + "  input: {u1: {saturation: 2}}\n",
       "u.yaml:8:28: error: model.input.u1.saturation: must be [low, high]"},
      {kModel + "  input: {u1: {deadband: -2}}\n",
       "u.yaml:8:26: error: model.input.u1.deadband: must be >= 0, not -2"},
      {kModel + "  input: {u1: {stiction: {band: 1}}}\n",
       "u.yaml:8:26: error: model.input.u1.stiction: `jump` is missing"},
      {kModel + "  input: {u1: {polynomial: []}}\n",
       "u.yaml:8:28: error: model.input.u1.polynomial: needs at least one coefficient"},
      {kModel + "  input: {u1: {deadband: 1, polynomial: [1]}}\n",
       "u.yaml:8:15: error: model.input.u1: takes one block only"},
      {kModel + "  output: {y1: {deadband: 1}}\n",
       "u.yaml:8:17: error: model.output.y1.deadband: unknown key (known: saturation, offset, "
       "scale)"},
      {kModel + "  output: {y1: {scale: 0}}\n",
       "u.yaml:8:24: error: model.output.y1.scale: must not be 0"},
      {kModel + "  operating_point: {p1: 3}\n",
       "u.yaml:8:21: error: model.operating_point.p1: unknown tag (did you mean 'u1'?)"},
      {kModel + "  operating_point: {u1: 3}\noperating_point: {u1: 3}\n",
       "u.yaml:8:20: error: model.operating_point: given twice; also at the top level"},
      // Settings
      {kModel + "monitor: {memory: 1}\n",
       "u.yaml:8:19: error: monitor.memory: must be longer than the sample time"},
      {kModel + "monitor: {false_alarm_rate: 1}\n",
       "u.yaml:8:29: error: monitor.false_alarm_rate: must be > 0 and < 1, not 1"},
      {kModel + "monitor: {first_lag: 30}\n",
       "u.yaml:8:22: error: monitor.first_lag: first_lag must not be above last_lag"},
      {kModel + "alarms: {clear_p_value: 1e-9}\n",
       "u.yaml:8:25: error: alarms.clear_p_value: clear_p_value must not be below raise_p_value"},
      {kModel + "alarms: {controller: {class: alarm, action: shed it}}\n",
       "u.yaml:8:30: error: alarms.controller.class: an alarm needs an operator's answer in time: "
       "give consequence, time_to_respond, or leave it an alert"},
      {kModel + "alarms: {controller: {class: loud}}\n",
       "u.yaml:8:30: error: alarms.controller.class: must be one of event, alert, alarm, not "
       "'loud'"},
      {kModel + "alarms: {max_shelve: 0}\n",
       "u.yaml:8:22: error: alarms.max_shelve: must be >= 1 and <= 2678400, not 0"},
      {kModel + "alarms: {on_dely: 1}\n",
       "u.yaml:8:10: error: alarms.on_dely: unknown key (did you mean 'on_delay'?)"},
      {kModel + "dds: {domain: 231}\n",
       "u.yaml:8:15: error: dds.domain: must be >= 0 and <= 230, not 231"},
      {kModel + "dds: {multicast: 1}\n",
       "u.yaml:8:18: error: dds.multicast: must be true or false, not '1'"},
      {kModel + "dds: {security: keys}\n",
       "u.yaml:8:17: error: dds.security: must be an absolute path: programs start in different "
       "folders"},
      {kModel + "dds: {peers: [a, [b]]}\n",
       "u.yaml:8:18: error: dds.peers[1]: must be a text, not a list"},
      // Simulation
      {kModel + "simulation: {move_blocks: [50, 60]}\n",
       "u.yaml:8:27: error: simulation.move_blocks: the move_blocks add up to 110 samples, more "
       "than prediction_horizon"},
      {kModel + "simulation: {limits: {u1: {low: 1, high: 1}}}\n",
       "u.yaml:8:42: error: simulation.limits.u1.high: must be above low"},
      {kModel + "simulation: {limits: {y1: {max_move: 1}}}\n",
       "u.yaml:8:28: error: simulation.limits.y1.max_move: unknown key (known: low, high)"},
      {kModel + "simulation: {noise: {sigma: -1}}\n",
       "u.yaml:8:29: error: simulation.noise.sigma: must be >= 0, not -1"},
      {kModel + "simulation: {noise: {y1: {pole: 1}}}\n",
       "u.yaml:8:33: error: simulation.noise.y1.pole: must be >= 0 and < 1, not 1"},
      {kModel + "simulation: {noise: {y1: {pole: 0}, sigma: 1}}\n",
       "u.yaml:8:37: error: simulation.noise.sigma: give it for all at once or below each tag, not "
       "both"},
      {kModel + "simulation: {cv_weights: {y3: 1}}\n",
       "u.yaml:8:27: error: simulation.cv_weights.y3: unknown tag (did you mean 'y1'?)"},
      {kModel + "simulation: {setpoints: {hold: 0}}\n",
       "u.yaml:8:32: error: simulation.setpoints.hold: must be >= 1 and <= 100000, not 0"},
  }));
  CAPTURE(text);
  const std::vector<std::string> found = findings_below(text);
  REQUIRE(found.size() == 1);
  CHECK(found[0] == finding);
}

TEST_CASE("Mistakes in the head of a file are told at their place") {
  const auto [text, finding] = GENERATE(values<Case>({
      {"unit: t\nsample_time: abc\nsignals: {mv: u1, cv: {tag: y1, prediction: p}}\nmodel: "
       "{channels: {cv: y1, mv: u1, gain: 1}}\n",
       "u.yaml:2:14: error: sample_time: must be a number, not 'abc'"},
      {"unit: t\nsample_time: 0\nsignals: {mv: u1, cv: y1}\nmodel: {channels: {cv: y1, mv: u1, "
       "gain: 1}}\n",
       "u.yaml:2:14: error: sample_time: must be > 0, not 0"},
      {"unit: t\nsample_time: -1\nsignals: {mv: u1, cv: y1}\nmodel: {channels: {cv: y1, mv: u1, "
       "gain: 1}}\n",
       "u.yaml:2:14: error: sample_time: must be > 0, not -1"},
      {"unit: a/b\nsample_time: 1\nsignals: {mv: u1, cv: y1}\nmodel: {channels: {cv: y1, mv: u1, "
       "gain: 1}}\n",
       "u.yaml:1:7: error: unit: must not hold '/', since files are named after the unit"},
      {"unit: ..\nsample_time: 1\nsignals: {mv: u1, cv: y1}\nmodel: {channels: {cv: y1, mv: u1, "
       "gain: 1}}\n",
       "u.yaml:1:7: error: unit: must not be '..', since files are named after the unit"},
      {"unit: t\nsample_time: 1\n", "u.yaml:1:1: error: `signals` is missing"},
      {"unit: t\nsample_time: 1\nsignals: {mv: u1}\n",
       "u.yaml:3:10: error: signals: `cv` needs at least one controlled variable"},
      {"unit: t\nsample_time: 1\nsignals: {mv: [], cv: y1}\n",
       "u.yaml:3:10: error: signals: `mv` needs at least one manipulated variable"},
      {"unit: t\nsample_time: 1\nsignals: {mv: [{tag: u1, low: 5, high: 5}], cv: y1}\nmodel: "
       "{channels: {cv: y1, mv: u1, gain: 1}}\n",
       "u.yaml:3:40: error: signals.mv[0].high: must be above low"},
      {"unit: t\nsample_time: 1\nsignals: {mv: u1, cv: [{tag: y1, low: 2, high: -1}]}\nmodel: "
       "{channels: {cv: y1, mv: u1, gain: 1}}\n",
       "u.yaml:3:48: error: signals.cv[0].high: must be above low"},
      {"unit: t\nsample_time: 1\nsignals: {mv: {tag: u1, low: x}, cv: y1}\nmodel: {channels: {cv: "
       "y1, mv: u1, gain: 1}}\n",
       "u.yaml:3:30: error: signals.mv.low: must be a number, not 'x'"},
      {"unit: t\nsample_time: 1\nsignals: {mv: u1, aux: {tag: a1, low: 0}, cv: y1}\nmodel: "
       "{channels: {cv: y1, mv: u1, gain: 1}}\n",
       "u.yaml:3:34: error: signals.aux.low: unknown key (known: tag, unit, description)"},
      {"- 1\n- 2\n",
       "u.yaml:1:1: error: a unit file is a map of keys such as `unit:` and "
       "`signals:`"},
      {"", "u.yaml:1:1: error: the file is empty"},
      {"# nothing\n", "u.yaml:1:1: error: the file is empty"},
      {std::string("unit: t\n\0\0", 10), "u.yaml:2:1: error: a zero byte: this is no text file"},
      {std::string(3000, '['), "u.yaml:1:1: error: is nested too deeply"},
      {"unit: [1, 2\nfoo: }\n",
       "u.yaml:2:4: error: not valid YAML: end of sequence flow not found"},
      {"unit: t\nsignals:\n mv: u1\n  cv: y1\n",
       "u.yaml:4:5: error: not valid YAML: illegal map value; this line or one above it begins too "
       "far left or right"},
      {"unit: t\nsignals:\n  mv: u1\n cv: y1\n",
       "u.yaml:4:2: error: not valid YAML: end of map not found; this line or one above it begins "
       "too far left or right"},
      {"unit: t\nsignals:\n\tmv: u1\n",
       "u.yaml:3:4: error: not valid YAML: illegal map value; a tab begins this line, and only "
       "blanks may"},
      {kHead + kModel + "---\nunit: b\n",
       "u.yaml:8:1: error: text after the end of the document; give one document per file"},
  }));
  CAPTURE(text);
  const std::vector<std::string> found = findings_of(text);
  REQUIRE(found.size() == 1);
  CHECK(found[0] == finding);
}

TEST_CASE("Tags share one name space") {
  const std::vector<std::string> found = findings_of(
      "unit: t\n"
      "sample_time: 1\n"
      "signals:\n"
      "  mv: [u1, u1, time, '', \" u\", \"a\\nb\"]\n"
      "  dv: [{unit: m}]\n"
      "  cv:\n"
      "    - {tag: y1, prediction: u1, setpoint: y1, tga: 3}\n"
      "    - y2.quality\n"
      "  aux: y1\n"
      "model: {channels: [{cv: y1, mv: u1, gain: 1}]}\n");
  const std::vector<std::string> expected = {
      "u.yaml:4:12: error: signals.mv[1]: tag 'u1' is already used in line 4",
      ("u.yaml:4:16: error: signals.mv[2]: 'time' is the name of the time column and cannot be a "
       "tag"),
      "u.yaml:4:22: error: signals.mv[3]: must not be empty",
      "u.yaml:4:26: error: signals.mv[4]: a tag must not begin or end with a space",
      "u.yaml:4:32: error: signals.mv[5]: must not hold control characters",
      "u.yaml:5:8: error: signals.dv[0]: `tag` is missing",
      "u.yaml:7:29: error: signals.cv[0].prediction: tag 'u1' is already used in line 4",
      "u.yaml:7:43: error: signals.cv[0].setpoint: tag 'y1' is already used in line 7",
      "u.yaml:7:47: error: signals.cv[0].tga: unknown key (did you mean 'tag'?)",
      ("u.yaml:8:7: error: signals.cv[1]: a tag must not end in '.quality', the name of a quality "
       "column"),
      "u.yaml:9:8: error: signals.aux: tag 'y1' is already used in line 7",
  };
  CHECK(found == expected);
}

TEST_CASE("All findings come at once, in the order of the file") {
  const std::vector<std::string> found = findings_of(
      "unit: t\n"
      "sample_time: fast\n"
      "signals: {mv: u1, cv: y1, xv: z}\n"
      "model:\n"
      "  channels:\n"
      "    - {cv: y1, mv: u2, gian: 4}\n"
      "alarms: {on_delay: -1}\n"
      "dds: {domain: x}\n");
  const std::vector<std::string> expected = {
      "u.yaml:2:14: error: sample_time: must be a number, not 'fast'",
      "u.yaml:3:27: error: signals.xv: unknown key (did you mean 'mv'?)",
      "u.yaml:6:7: error: model.channels[0]: needs `gain`, `numerator`, `step_response` or `tanks`",
      ("u.yaml:6:20: error: model.channels[0].mv: 'u2' is no mv or dv of this unit (did you mean "
       "'u1'?)"),
      "u.yaml:6:24: error: model.channels[0].gian: unknown key (did you mean 'gain'?)",
      "u.yaml:7:20: error: alarms.on_delay: must be >= 0, not -1",
      "u.yaml:8:15: error: dds.domain: must be a number, not 'x'",
  };
  CHECK(found == expected);
}

TEST_CASE("A unit without a model is allowed where predictions come with the data") {
  const auto alone = load_unit_text(kHead, "u.yaml");
  REQUIRE(alone.findings.size() == 1);
  CHECK(alone.ok());
  CHECK(format(alone.findings[0]) ==
        "u.yaml:1:1: warning: `model` is missing; predictions must come with the data");
  CHECK_FALSE(alone.config.has_model());

  const auto without = load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: [y1, {tag: y2, prediction: p}]}\n", "u.yaml");
  REQUIRE(without.findings.size() == 1);
  CHECK(format(without.findings[0]) ==
        "u.yaml:1:1: error: `model` is missing and these have no prediction tag: y1");
}

TEST_CASE("A CV that no channel leads to is a warning, an MV without a channel is none") {
  const auto result = load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2], cv: [y1, y2]}\n"
      "model: {channels: [{cv: y1, mv: u1, gain: 1}]}\n",
      "u.yaml");
  REQUIRE(result.findings.size() == 1);
  CHECK(result.ok());
  CHECK(format(result.findings[0]) == "u.yaml:4:8: warning: model: no channel leads to cv 'y2'");
}

TEST_CASE("An operating point far outside an MV's limits is a warning, one beside them is none") {
  const auto findings = [](const std::string& value) {
    const auto result = load_unit_text(
        "unit: t\nsample_time: 1\nsignals: {mv: {tag: u1, low: 80, high: 160}, cv: y1}\n"
        "model:\n  channels: [{cv: y1, mv: u1, gain: 1}]\n  operating_point: {u1: " +
            value + "}\n",
        "u.yaml");
    CHECK(result.ok());
    std::vector<std::string> texts;
    for (const auto& finding : result.findings) texts.push_back(format(finding));
    return texts;
  };
  CHECK(findings("120").empty());
  CHECK(findings("200").empty());
  CHECK(findings("1200") ==
        std::vector<std::string>{"u.yaml:6:25: warning: model.operating_point.u1: lies far outside "
                                 "the signal's own limits, 80 to 160"});
}

// A byte of ISO 8859-1 (the degree sign), one that is cut off, a surrogate: all pass yaml-cpp, and
// no JSON could be made of them later.
TEST_CASE("A file that is no UTF-8 is refused at the first byte that is none") {
  for (const char* bytes : {"\xb0", "\xc2", "\xed\xa0\x80"}) {
    const std::string head = "unit: t\nsample_time: 2\nsignals:\n  mv: [{tag: u1, description: \"";
    const std::vector<std::string> findings = findings_of(head + bytes + "\"}]\n");
    // Behind the 31 letters of `  mv: [{tag: u1, description: "`.
    CHECK(findings ==
          std::vector<std::string>{"u.yaml:4:32: error: is no UTF-8; save the file as UTF-8"});
  }
  CHECK(findings_of("unit: t\xff\n").front().rfind("u.yaml:1:8: ", 0) == 0);
  CHECK(findings_below("  # \u00b0C\n" + kModel).empty());
}

TEST_CASE("A finding is one line of ordinary length, whatever the file holds") {
  for (const std::string& text :
       {kHead + "\"a\\nb\\e[2J" + std::string(1'000'000, 'x') + "\": 1\n" + kModel,
        std::string("unit: \"t\\u009b\"\n"),
        "unit: t\nsample_time: \"" + std::string(1'000'000, '1') + "x\"\n"})
    for (const std::string& finding : findings_of(text)) {
      CHECK(finding.size() < 3000);
      CHECK(finding.find('\n') == std::string::npos);
      CHECK(finding.find('\x1b') == std::string::npos);
    }
}

TEST_CASE("A list longer than anything takes is refused before it is a tree") {
  std::string text =
      "unit: u\nsample_time: 1\nsignals: {mv: [u1], cv: [y1]}\nmodel:\n"
      "  channels: [{cv: y1, mv: u1, step_response: [0";
  for (int i = 0; i < 200000; ++i) text += ",1";
  const mpm::config::LoadResult loaded = mpm::config::load_unit_text(text + "]}]\n", "u.yaml");
  REQUIRE(loaded.findings.size() == 1);
  CHECK(format(loaded.findings[0]) ==
        "u.yaml:5:46: error: has more values than anything here takes");
}
