#include "daemon/report/page/page.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "core/identify/causes/catalog.hpp"
#include "daemon/report/page/diagnosis_page.hpp"
#include "daemon/report/page/identification_page.hpp"
#include "tests/daemon/report/identification/small_run.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test {
namespace {

using Json = nlohmann::ordered_json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// What stands between the first `open` and the next `close` after it.
std::string between(const std::string& text, const std::string& open, const std::string& close) {
  const auto from = text.find(open);
  REQUIRE(from != std::string::npos);
  const auto to = text.find(close, from + open.size());
  REQUIRE(to != std::string::npos);
  return text.substr(from + open.size(), to - from - open.size());
}

/// The page without what stands inside its scripts and styles.
std::string skeleton(const std::string& page) {
  std::string result;
  for (std::size_t at = 0; at < page.size();) {
    const auto script = page.find("<script", at), style = page.find("<style", at);
    const auto open = std::min(script, style);
    if (open == std::string::npos) return result + page.substr(at);
    const char* close = open == script ? "</script>" : "</style>";
    result += page.substr(at, open - at);
    at = page.find(close, open);
    REQUIRE(at != std::string::npos);
    at += std::string(close).size();
  }
  return result;
}

/// Elements that are opened and not closed, or the other way round.
std::vector<std::string> unbalanced(const std::string& html) {
  static const std::regex tag("<(/?)([a-z0-9]+)[^>]*>");
  std::vector<std::string> open;
  for (std::sregex_iterator at(html.begin(), html.end(), tag), end; at != end; ++at) {
    const std::string name = (*at)[2];
    if (name == "meta") continue;
    if ((*at)[1].length() == 0)
      open.push_back(name);
    else if (!open.empty() && open.back() == name)
      open.pop_back();
    else
      return {"/" + name};
  }
  return open;
}

template <class AnyRun>
std::string page_of(const AnyRun& run) {
  return report::page_html(report::page_data(run));
}

Json data_in(const std::string& page) {
  return Json::parse(between(page, "id=\"data\">", "</script>"));
}

std::string text_of(const Json& json) { return json.get<std::string>(); }

TEST_CASE("the page is whole, well formed and small") {
  const std::string page = page_of(sample_run());
  CHECK(unbalanced(skeleton(page)).empty());
  CHECK(page.rfind("<!DOCTYPE html>", 0) == 0);
  CHECK(holds(page, "<title>Diagnosis of shell</title>"));
  CHECK_FALSE(holds(page, "<!--"));
  CHECK(holds(page, "Permission is hereby granted"));  // uPlot's licence goes where uPlot goes
  CHECK(page.size() < 1'000'000);
  CHECK(page == page_of(sample_run()));
}

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

TEST_CASE("an undetermined diagnosis shows nothing as good") {
  report::DiagnosisRun run = matching_run();
  run.diagnosis.verdict = DiagnosisVerdict::kUndetermined;
  for (const Json& row : report::page_data(run)["matrix"]["rows"])
    for (const Json& cell : row["cells"]) CHECK(cell["state"] == "doubt");
}

TEST_CASE("the page needs nothing from elsewhere") {
  std::string page = page_of(matching_run());
  const std::string home = "https://github.com/leeoniya/uPlot";  // whose library it is
  page.replace(page.find(home), home.size(), "");
  for (const char* elsewhere : {"http:", "https:", "//www", " src=", "@import", "url(h", "fetch(",
                                "XMLHttpRequest", "import("})
    CHECK_FALSE(holds(page, elsewhere));
  CHECK(holds(page, "default-src 'none'"));
}

TEST_CASE("no name of the unit file can break out of the page") {
  report::DiagnosisRun run = sample_run(600);
  run.unit.unit = "</script><b>&";
  run.unit.cv[2].tag = "y\"3</script><!--";
  run.unit.mv[0].description = "\xff not UTF-8";
  run.unit.mv[0].tag = "\xfe</style>";
  const std::string page = page_of(run);
  CHECK(unbalanced(skeleton(page)).empty());
  const Json data = data_in(page);
  CHECK(data["title"] == "Diagnosis of </script><b>&");
  CHECK(data["cvs"][2]["tag"] == "y\"3</script><!--");
}

TEST_CASE("a long recording is thinned until the page is small") {
  CHECK(page_of(sample_run(200'000)).size() < 1'000'000);
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

TEST_CASE("a diagnosis without simulations still makes a page") {
  report::DiagnosisRun run = matching_run();
  run.diagnosis.before.resize(0, 0);
  run.diagnosis.after.resize(0, 0);
  run.diagnosis.scores.clear();
  CHECK(unbalanced(skeleton(page_of(run))).empty());
}

report::IdentificationRun identified() {
  report::IdentificationRun run = small_run();
  run.unit.model = {};
  run.recording.inputs = Eigen::MatrixXd::Zero(100, 2);
  run.recording.inputs.col(0).tail(60).setOnes();
  ChannelAnswer& known = run.identification.channels[0];
  for (int i = 0; i < 30; ++i) {
    known.step_times_s.push_back(i);
    known.step.push_back(2.0 * (1.0 - std::exp(-i / 8.0)));
    known.step_sd.push_back(0.05);
  }
  return run;
}

TEST_CASE("an identification has the same page") {
  const std::string page = page_of(identified());
  CHECK(unbalanced(skeleton(page)).empty());
  const Json data = data_in(page);
  CHECK(data["title"] == "Model of u");
  CHECK(data["sentence"] ==
        "1 of 2 channels of u was identified; the others are left out, with the reason.");
  CHECK(data["matrix"]["rows"][0]["cells"][0] == Json({{"state", "right"}, {"text", "gain 2.00"}}));
  CHECK(data["matrix"]["rows"][0]["cells"][1]["text"] == "input still");
  CHECK(data["numbers"]["rows"][0]["gain"]["new"] == "2.00");
  REQUIRE(data["responses"].size() == 1);
  CHECK(data["responses"][0]["bands"][0]["high"][0] == Approx(1.96 * 0.05).margin(1e-3));
  CHECK(data["refused"][0] == "v \u2192 y: v does not move.");
  CHECK(data["views"].size() == 1);
}

// For looking at, and for tests/daemon/report/page/browser: MPM_PAGE_FOLDER=... daemon_tests
// '[.page]'
TEST_CASE("write pages to look at", "[.page]") {
  const char* folder = std::getenv("MPM_PAGE_FOLDER");
  REQUIRE(folder != nullptr);
  const auto write = [&](const char* name, const auto& run) {
    std::ofstream(std::string(folder) + "/" + name) << page_of(run);
  };
  write("mismatch.html", sample_run());
  write("match.html", matching_run());
  write("identified.html", identified());
  report::DiagnosisRun bent = sample_run();
  bent.diagnosis.extended.input_blocks[0] = Stiction{0.08, 0.03};
  bent.diagnosis.extended.input_blocks[1] = Polynomial{{0.8, 0.9}};
  bent.diagnosis.extended.output_blocks[2] = Saturation{-2.0, 2.5};
  bent.diagnosis.findings[0].subject = {&causes::input_polynomial(), {-1, 1}};
  bent.diagnosis.findings[1] = bent.diagnosis.refused[0];
  bent.diagnosis.findings[1].subject.place.input = 0;
  write("bent.html", bent);
  report::DiagnosisRun dates = sample_run();
  dates.recording.start_s = 1767225600.0;
  dates.recording.sample_time_s = 60.0;
  dates.diagnosis.findings[2].onset_s = dates.recording.start_s + 2100.0 * 60.0;
  dates.zone = std::make_shared<files::TimeZone>("Europe/Berlin");
  dates.validation = dates.recording;
  dates.validation_file = "next_week.csv";
  dates.diagnosis.validation_before = dates.diagnosis.before;
  dates.diagnosis.validation_after = dates.diagnosis.after;
  write("dates.html", dates);
}

}  // namespace
}  // namespace mpm::test
