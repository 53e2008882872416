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

#include "core/identify/causes/catalog.hpp"
#include "daemon/report/page/diagnosis_page.hpp"
#include "daemon/report/page/identification_page.hpp"
#include "tests/daemon/report/identification/identified_run.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test::page_test {
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

TEST_CASE("a diagnosis without simulations still makes a page") {
  report::DiagnosisRun run = matching_run();
  run.diagnosis.before.resize(0, 0);
  run.diagnosis.after.resize(0, 0);
  run.diagnosis.scores.clear();
  CHECK(unbalanced(skeleton(page_of(run))).empty());
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
  write("identified.html", identified_run());
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
}  // namespace mpm::test::page_test
