#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "config/load_unit.hpp"
#include "core/identify/causes/catalog.hpp"
#include "daemon/report/diagnosis/diagnosis_report.hpp"
#include "daemon/report/diagnosis/explain.hpp"
#include "daemon/report/diagnosis/extended_unit.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test::diagnosis_report_test {
namespace {

using nlohmann::ordered_json;
using report::DiagnosisRun;

std::vector<std::string> keys(const ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& entry : object.items()) names.push_back(entry.key());
  return names;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a model is said to hold beside a disturbance only where its gains are known") {
  DiagnosisRun run = sample_run();
  std::erase_if(run.diagnosis.findings, [](const Finding& finding) {
    return finding.subject.cause != &causes::step_disturbance();
  });
  REQUIRE(run.diagnosis.findings.size() == 1);
  run.diagnosis.unexplained.clear();
  run.diagnosis.rejected.clear();
  run.diagnosis.channels.assign(1, {});
  Parameter& gain = run.diagnosis.channels[0].gain_ratio;
  gain.low = 0.9;
  gain.high = 1.1;
  CHECK(report::verdict_headline(run) ==
        "The model of shell holds, but something that it does not know of disturbs the plant: one "
        "cause was found.");
  gain.low = 0.2;
  gain.high = 1.8;
  CHECK(
      report::verdict_headline(run) ==
      "These data do not tell whether the model of shell matches the plant, but something that it "
      "does not know of disturbs it: one cause was found.");
}

TEST_CASE("report.json has the keys of its contract") {
  const ordered_json report = ordered_json::parse(report::to_json(sample_run()).dump());
  CHECK(report["unit"] == "shell");
  CHECK(report["samples"] == 3000);
  CHECK(report["fit_samples"] == 2000);
  CHECK(report["validation_samples"] == 1000);
  CHECK(report["verdict"] == "mismatch");
  CHECK(report["extended_model"] == "extended.yaml");

  const ordered_json& gain = report["findings"][0];
  CHECK(gain["cause"] == "gain");
  CHECK(gain["cv"] == "y3");
  CHECK(gain["mv"] == "u3");
  CHECK(gain["tag"].is_null());
  CHECK(gain["title"] == "Gain");
  const std::vector<std::string> begin = {"cause", "cv", "mv", "tag", "title", "parameters"};
  const std::vector<std::string> given_of_gain = keys(gain);
  CHECK(std::equal(begin.begin(), begin.end(), given_of_gain.begin()));
  CHECK(gain["parameters"] == ordered_json{{"gain_ratio", 1.402}});
  CHECK(gain["interval"]["gain_ratio"] == ordered_json{1.381, 1.424});
  CHECK(gain["confidence"] == 0.991);
  CHECK(gain["onset"].is_null());
  CHECK(gain["against"].size() == 2);
  CHECK(gain["rivals"][0]["cause"] == "output_scale");
  CHECK(gain["rivals"][0]["worse"] == 14.2);

  const ordered_json& input = report["findings"][1];
  CHECK(input["cause"] == "unmodelled_input");
  CHECK(input["tag"] == "t_amb");
  CHECK(input["title"] == "Input that the model leaves out");
  CHECK(input["mv"].is_null());

  const ordered_json& step = report["findings"][2];
  CHECK(step["parameters"]["shape"] == "step");
  CHECK(step["parameters"]["onset"] == 2100.0);
  CHECK(step["onset"] == 2100.0);
  CHECK(step["rivals"][0]["inseparable"] == true);

  REQUIRE(report["validation"].size() == 3);
  const std::vector<std::string> first = {"cv",         "rmse_before", "rmse_after",
                                          "fit_before", "fit_after",   "gain_interval"};
  const std::vector<std::string> given = keys(report["validation"][0]);
  CHECK(std::equal(first.begin(), first.end(), given.begin()));
  CHECK(report["refused"][0]["cause"] == "stiction");
  CHECK(report["unexplained"][0]["cv"] == "y2");
  CHECK(report["channels"].size() == 9);
  CHECK(report["closed_loop"]["cvs"][2]["error_variance_after"] == 0.018);
}

TEST_CASE("a match has no findings and an undetermined verdict a reason") {
  DiagnosisRun run = matching_run();
  ordered_json report = report::to_json(run);
  CHECK(report["verdict"] == "match");
  CHECK(report["findings"].empty());
  run.diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  run.diagnosis.reason = "u2 hardly moves";
  report = report::to_json(run);
  CHECK(report["verdict"] == "undetermined");
  CHECK(report["reason"] == "u2 hardly moves");
  CHECK(report["details"] == "u2 hardly moves.");
  run.diagnosis.reason = "too little moves";
  CHECK(report::to_json(run)["details"] == "Too little moves.");
}

TEST_CASE("a level that has moved by more than the CV does is said, and no other") {
  DiagnosisRun run = matching_run();
  const auto says = [&](const std::string& text) {
    return report::to_text(run).find(text) != std::string::npos;
  };
  CHECK_FALSE(says("its simulation on unseen samples"));
  CvScore& score = run.diagnosis.scores[1];
  score.fit_after = -20.0;
  score.rmse_after = 0.5;
  score.level_after = -0.4;
  CHECK(says("y2 lies 0.4 "));
  CHECK(says(" below its simulation on unseen samples"));
  score.level_after = 0.3;  // less than half of the squared error
  CHECK_FALSE(says("its simulation on unseen samples"));
  score.level_after = 0.4;
  score.fit_after = 1.0;
  CHECK_FALSE(says("its simulation on unseen samples"));
}

// A repair of something else begins at the level where the CV is: it gets no credit for that.
TEST_CASE("a level that the extended model has taken over without a finding is said") {
  DiagnosisRun run = matching_run();
  const auto says = [&](const std::string& text) {
    return report::to_text(run).find(text) != std::string::npos;
  };
  CvScore& score = run.diagnosis.scores[1];
  score.fit_before = -20.0;
  score.rmse_before = 0.5;
  run.diagnosis.extended.output_origin(1) = run.unit.model.output_origin(1) + 0.4;
  CHECK(says("The extended model has y2 0.4 "));
  CHECK(says(" higher than the unit file's"));
  score.fit_after = -10.0;  // it is there still
  score.rmse_after = 0.5;
  score.level_after = 0.4;
  CHECK_FALSE(says("The extended model has"));
  score.fit_after = 90.0;
  run.diagnosis.extended.output_origin(1) = run.unit.model.output_origin(1) + 0.3;
  CHECK_FALSE(says("The extended model has"));  // less than half of the squared error
  run.diagnosis.extended.output_origin = run.unit.model.output_origin;
  CHECK_FALSE(says("The extended model has"));
}

TEST_CASE("what is not a number is null, and the report stays JSON") {
  DiagnosisRun run = sample_run(600);
  run.diagnosis.scores[0].rmse_after = std::nan("");
  run.diagnosis.findings[0].parameters[0].high = HUGE_VAL;
  const ordered_json report = ordered_json::parse(report::to_json(run).dump());
  CHECK(report["validation"][0]["rmse_after"].is_null());
  CHECK(report["findings"][0]["interval"]["gain_ratio"][1].is_null());
}

/// All numbers that a cause has, as far as sentences say them.
std::vector<Parameter> parameters_of(const Cause& cause) {
  struct Number {
    double value, low, high;
  };
  const std::map<std::string, Number> numbers = {{"gain_ratio", {0.75, 0.7, 0.8}},
                                                 {"time_constant_ratio", {1.5, 1.4, 1.6}},
                                                 {"dead_time_error", {-3.0, -4, -2}},
                                                 {"width", {0.3, 0.2, 0.4}},
                                                 {"low", {-1.0, -1.1, -0.9}},
                                                 {"high", {1.0, 0.9, 1.1}},
                                                 {"band", {0.4, 0.3, 0.5}},
                                                 {"jump", {0.2, 0.1, 0.3}},
                                                 {"gain", {1.0, 0.9, 1.1}},
                                                 {"size", {-0.4, -0.5, -0.3}},
                                                 {"variance_ratio", {9.0, 8.0, 10.0}},
                                                 {"period", {60.0, 59.0, 61.0}},
                                                 {"force", {0.1, 0.05, 0.15}}};
  std::vector<Parameter> parameters;
  for (const Finding& finding : findings_of(cause))
    for (const Parameter& parameter : finding.parameters) {
      const auto number = numbers.find(parameter.quantity->name);
      const bool given =
          std::any_of(parameters.begin(), parameters.end(),
                      [&](const Parameter& other) { return other.quantity == parameter.quantity; });
      if (number == numbers.end() || given) continue;
      const auto [value, low, high] = number->second;
      parameters.push_back({parameter.quantity, value, low, high});
    }
  return parameters;
}

TEST_CASE("every cause is explained in a sentence with its tags") {
  const DiagnosisRun run = sample_run(600);
  const auto explained = [&](const Subject& subject, bool with_parameters) {
    Finding finding;
    finding.subject = subject;
    if (with_parameters) finding.parameters = parameters_of(*subject.cause);
    return report::explain(run, finding);
  };
  for (const bool with : {true, false}) {
    for (const Cause* cause : causes::all()) {
      if (causes::is_unnamed(*cause)) continue;
      const bool aux = cause == &causes::unmodelled_input();
      const std::string text = explained({cause, {0, aux ? -1 : 1, aux ? 1 : -1}}, with);
      INFO(cause->name().text << ' ' << cause->kind() << ": " << text);
      CHECK(text.size() > 20);
      CHECK(text.back() == '.');
      CHECK((holds(text, "y1") || holds(text, "u2")));
      CHECK_FALSE(holds(text, "nan"));
      CHECK_FALSE(holds(text, "  "));
    }
  }
  CHECK(explained({&causes::gain(), {0, 0}}, true) ==
        "y1 answers u1 25 % less than the model says (gain 3.04 instead of 4.05 degC per m3/h; "
        "95 % interval 0.7 to 0.8 of the ratio).");
  CHECK(explained({&causes::dead_time(), {0, 0}}, true) ==
        "y1 answers u1 3 s sooner than the model says (dead time error 95 % interval -4 to -2 s).");
}

TEST_CASE("the extended unit takes new inputs as DVs, at the place that the model gives them") {
  DiagnosisRun run = sample_run(600);
  const config::UnitConfig unit = report::extended_unit(run.unit, run.diagnosis);
  REQUIRE(unit.dv.size() == 1);
  CHECK(unit.dv[0].tag == "t_amb");
  REQUIRE(unit.aux.size() == 1);
  CHECK(unit.aux[0].tag == "p_feed");
  CHECK(unit.input_tag(3) == "t_amb");
  run.diagnosis.new_inputs = {1, 0};
  CHECK_THROWS_AS(report::extended_unit(run.unit, run.diagnosis), std::logic_error);
}

TEST_CASE("extended.yaml says what was changed and loads back as it was found") {
  const DiagnosisRun run = sample_run(3000);
  const std::string text = report::extended_yaml(run);
  CHECK(text.rfind("# Written by mpm 0.1.0", 0) == 0);
  CHECK(holds(text, "# - y3 answers u3 40 % more"));
  CHECK(holds(text, "t_amb was under `aux`"));
  const config::LoadResult back = config::load_unit_text(text, "extended.yaml");
  REQUIRE(back.ok());
  const ModelSpec& model = back.config.model;
  CHECK(model.input_count == 4);
  REQUIRE(model.channels.size() == 10);
  const auto gain = [&](std::size_t i) {
    return std::get<TransferFunction>(model.channels[i].dynamics).gain;
  };
  CHECK(gain(8) == 1.4 * 7.20);
  CHECK(model.channels[9].input == 3);
  CHECK(model.input_origin(3) == 288.0);
  REQUIRE(model.disturbances.size() == 1);
  CHECK(model.disturbances[0].onset_s == 2100.0);

  DiagnosisRun matching = matching_run();
  matching.data_file = "y\xFF/x.csv";
  const std::string unchanged = report::extended_yaml(matching);
  CHECK(holds(unchanged, "y\\xff/x.csv"));
  const config::LoadResult same = config::load_unit_text(unchanged, "extended.yaml");
  REQUIRE(same.ok());
  CHECK(same.config.model.channels.size() == 9);
}

TEST_CASE("the terminal summary names verdict, findings and gains") {
  const std::string text = report::to_text(sample_run());
  CHECK(holds(text, "The model of shell does not match the plant: 3 causes were found."));
  CHECK(holds(text, "1. gain of u3 -> y3"));
  CHECK(holds(text, "or: output_disturbance (drift) on y2"));
  CHECK(holds(text, "an extension was tried and did not carry over"));
}

}  // namespace
}  // namespace mpm::test::diagnosis_report_test
