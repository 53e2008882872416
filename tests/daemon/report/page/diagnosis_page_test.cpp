#include "daemon/report/page/diagnosis_page.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "config/load_unit.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test::diagnosis_page_test {
namespace {

using Json = nlohmann::ordered_json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string text_of(const Json& json) { return json.get<std::string>(); }

TEST_CASE("the first screen says what is wrong, where and by how much") {
  const Json data = report::page_data(sample_run());
  CHECK(
      data["sentence"] ==
      "The model of shell does not match the plant: u3 \u2192 y3 (gain \u00d7 1.402), t_amb \u2192 "
      "y1 (missing input) and 1 more finding.");
  REQUIRE(data["matrix"]["inputs"] == Json({"u1", "u2", "u3", "t_amb", "by itself"}));
  const Json& cells = data["matrix"]["rows"][2]["cells"];
  CHECK(cells[2]["state"] == "wrong");
  CHECK(cells[2]["findings"][0] == Json({{"number", 1}, {"text", "gain \u00d7 1.402"}}));
  CHECK(cells[0]["state"] == "right");
  CHECK(data["matrix"]["rows"][1]["cells"][4]["findings"][0]["text"] == "step +0.610 degC");
  const Json& row = data["numbers"]["rows"].back();
  CHECK(row["gain"]["old"] == "7.2");
  CHECK(row["gain"]["new"] == "10.08");
  CHECK(row["gain"]["interval"] == "9.94 to 10.25");
  CHECK(row["gain"]["unit"] == "degC per m3/h");
  CHECK(config::load_unit_text("unit: u\nsample_time: 1\nsignals: {mv: [u1, u2, u3], dv: [t_amb], "
                               "cv: [y1, y2, y3]}\n" +
                                   text_of(data["numbers"]["yaml"]),
                               "copied.yaml")
            .ok());
}

TEST_CASE("each finding shows where it tells most") {
  const Json data = report::page_data(sample_run());
  REQUIRE(data["views"].size() == 3);
  const Json& gain = data["views"][0];
  CHECK(gain["finding"] == 1);
  REQUIRE(gain["plots"].size() == 2);  // the CV, and what acts
  CHECK(gain["plots"][0]["lines"].size() == 3);
  CHECK(gain["plots"][1]["y"]["label"] == "u3, m3/h");
  // The step begins at 2100 s, a quarter into its view.
  const Json& step = data["views"][2]["plots"][0];
  const Json& stretch = step["x"]["stretches"][0];
  const double from = stretch[0],
               until = from + stretch[1].get<double>() * stretch[2].get<double>();
  CHECK(step["marks"][0]["x"] == 2100.0);
  CHECK((2100.0 - from) / (until - from) == Approx(0.25).margin(0.02));
  // The fit ended at row 2000.
  CHECK(step["unseen"] == 2000.0);
}

TEST_CASE("findings are told in words and have their own picture") {
  const Json data = report::page_data(sample_run());
  const Json& gain = data["findings"][0];
  CHECK(gain["facts"][0] == Json({"This cause", "all but certain"}));
  CHECK(text_of(gain["text"]).rfind("y3 answers u3 40 % more than the model says", 0) == 0);
  CHECK(gain["numbers"].empty());
  const Json& response = gain["plots"][0];
  CHECK(response["title"] == "u3 \u2192 y3, step response");
  // No line leaves its own band.
  const Json &after = response["lines"][1]["values"], &band = response["bands"][0];
  for (std::size_t i = 0; i < after.size(); ++i) {
    CHECK(after[i].get<double>() >= band["low"][i].get<double>());
    CHECK(after[i].get<double>() <= band["high"][i].get<double>());
  }
  const Json& input = data["findings"][1];
  CHECK(input["numbers"][1] == Json({"time constant", "20.6 s", "17.9 to 23.8"}));
  CHECK(input["plots"][1]["title"] == "How the error goes with t_amb");
  const Json& step = data["findings"][2];
  CHECK(step["plots"][0]["title"] == "Disturbance of y2");
  const std::string all = data.dump();
  for (const char* not_for_people : {"2 ln", "odds 1 to", "10^"})
    CHECK_FALSE(holds(all, not_for_people));
  CHECK(data["refused"].size() == 1);
  CHECK(data["unexplained"].size() == 1);
}

TEST_CASE("how well the unit is controlled is told where that is known") {
  report::DiagnosisRun run = sample_run(600);
  CHECK_FALSE(report::page_data(run).contains("control"));
  run.performance = PerformanceRecord();
  CHECK(report::page_data(run).contains("control"));
}

TEST_CASE("an error that may have grown has a minus as wide as a digit") {
  report::DiagnosisRun run = sample_run(600);
  run.diagnosis.scores.at(1).gain_low = -0.086;
  run.diagnosis.scores.at(1).gain_high = 0.3;
  run.diagnosis.scores.at(1).refused = false;
  CHECK(report::page_data(run)["errors"][1][3] == "\u22128.6 to 30 %");
}

TEST_CASE("data that say little are warned of") {
  report::DiagnosisRun run = sample_run(600);
  for (config::CvSignal& cv : run.unit.cv) cv.setpoint = cv.tag + "_sp";
  run.recording.setpoints = Eigen::MatrixXd::Constant(600, 3, 1.0);
  run.diagnosis.inputs = {{0, 0.05, true}, {1, 0.9, true}, {2, std::nullopt, false}};
  const Json warnings = report::page_data(run)["warnings"];
  REQUIRE(warnings.size() == 3);
  CHECK(text_of(warnings[0]).rfind("Constant set-points: y1_sp, y2_sp and y3_sp do not move", 0) ==
        0);
  CHECK(text_of(warnings[1]).rfind("Short: ", 0) == 0);
  CHECK(text_of(warnings[2]).rfind("Feedback: u1 moves almost only", 0) == 0);
}

TEST_CASE("runs share an axis of time, with nothing between them") {
  report::DiagnosisRun run = sample_run(600);
  run.recording.borders = {{200, 5000.0}};
  const Json stretches = report::page_data(run)["cvs"][0]["plots"][0]["x"]["stretches"];
  REQUIRE(stretches.size() == 2);
  CHECK(stretches[1][0] == stretches[0][0].get<double>() + 200.0 + 5000.0);
  CHECK(report::page_data(run)["cvs"][0]["plots"][0]["lines"][0]["values"][200].is_null());
}

TEST_CASE("a second recording has its own plots") {
  report::DiagnosisRun run = sample_run(600);
  run.validation = run.recording;
  run.diagnosis.validation_before = run.diagnosis.before;
  run.diagnosis.validation_after = run.diagnosis.after;
  const Json data = report::page_data(run);
  CHECK(data["cvs"][1]["plots"].size() == 4);
  CHECK(data["cvs"][1]["plots"][2]["title"] == "y2 (unseen)");
}

}  // namespace
}  // namespace mpm::test::diagnosis_page_test
