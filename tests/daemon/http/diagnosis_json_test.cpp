#include "daemon/http/diagnosis_json.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/daemon/http/sample_board.hpp"
#include "tests/system/process.hpp"

namespace mpm::http {
namespace {

TEST_CASE("the last diagnosis and its report are told") {
  const test::TemporaryFolder folder;
  const std::string place = "column/20240501T120000Z";
  std::filesystem::create_directories(folder.file(place));
  test::write_file(folder.file(place + "/report.html"), "page");
  test::write_file(folder.file(place + "/report.json"),
                   R"({"verdict":"mismatch","findings":[],"made_by":"x"})");
  test::SampleBoard sample;
  const KeptReports reports(folder.file(""));
  CHECK(diagnosis_json(sample.store(), reports)["last"].is_null());

  live::DiagnosisOutcome outcome;
  outcome.headline = "one cause was found";
  outcome.causes.resize(6);
  outcome.causes[3].cause = "gain";
  outcome.causes[3].text = "41 % more";
  outcome.causes[3].parameters = {{"gain_ratio", 1.41, 1.31, 1.51}};
  sample.feed().on_diagnosis(outcome);
  sample.fetch();
  const Json json = diagnosis_json(sample.store(), reports);
  CHECK(json["last"]["headline"] == "one cause was found");
  REQUIRE(json["last"]["causes"].size() == 1);
  CHECK(json["last"]["causes"][0]["mv"] == "FIC-102");
  CHECK(json["last"]["causes"][0]["cv"] == "AI-202");
  CHECK(json["last"]["causes"][0]["cause_intervals"]["gain_ratio"] == Json({1.31, 1.51}));
  CHECK(json["reports"][0]["html"] == "/reports/column/20240501T120000Z/report.html");
  CHECK(json["report"]["verdict"] == "mismatch");
  CHECK_FALSE(json["report"].contains("made_by"));
}

TEST_CASE("a report that is none is not told") {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.file("column/20240501T120000Z"));
  test::write_file(folder.file("column/20240501T120000Z/report.html"), "page");
  test::write_file(folder.file("column/20240501T120000Z/report.json"), "{");
  const test::SampleBoard sample;
  CHECK(diagnosis_json(sample.store(), KeptReports(folder.file("")))["report"].is_null());
}

TEST_CASE("a name becomes one part of a path") {
  CHECK(path_part("a/b c%") == "a%2Fb%20c%25");
  CHECK(path_part("shell-1_x.y~") == "shell-1_x.y~");
}

}  // namespace
}  // namespace mpm::http
