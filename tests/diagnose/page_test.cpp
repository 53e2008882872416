#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "daemon/report/page/page.hpp"
#include "daemon/report/page/page_data.hpp"
#include "tests/diagnose/sample_run.hpp"

namespace mpm::test {
namespace {

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

std::string page_of(const report::DiagnosisRun& run) {
  return report::page_html(report::page_data(run));
}

TEST_CASE("the page is whole, well formed and holds everything") {
  const std::string page = page_of(sample_run());
  CHECK(unbalanced(skeleton(page)).empty());
  CHECK(page.rfind("<!DOCTYPE html>", 0) == 0);
  CHECK(holds(page, "<title>Diagnosis of shell</title>"));
  CHECK(holds(page, "The model of shell does not match the plant: 3 causes were found."));
  CHECK_FALSE(holds(page, "<!--"));
  CHECK(page.size() < 1'000'000);

  const auto data = nlohmann::json::parse(between(page, "id=\"data\">", "</script>"));
  CHECK(data["report"]["findings"].size() == 3);
  CHECK(data["report"]["closed_loop"]["seeds"].size() == 3);
  CHECK(data["sets"][0]["boundary"] == 2000.0);
  CHECK(data["inputs"].size() == 4);
  CHECK(data["inputs"][3]["new"] == true);
  REQUIRE(data["cvs"].size() == 3);
  for (const auto& cv : data["cvs"]) {
    CHECK(cv["found"] == true);
    CHECK(cv["sets"][0]["measured"].size() == 3000);
    CHECK(cv["spectrum"]["frequency"].size() == cv["spectrum"]["after"].size());
    CHECK(cv["levels"].size() == 5);
    CHECK(cv["correlations"].size() == 4);
    CHECK(cv["steps"].size() >= 3);
  }
  CHECK(data["cvs"][0]["sets"][0]["measured"][510].is_null());
  CHECK(data["cvs"][0]["sets"][0]["residual_before"][510].is_null());
}

TEST_CASE("the page needs nothing from elsewhere") {
  std::string page = page_of(matching_run());
  const std::string name_space = "http://www.w3.org/2000/svg";  // a name, never fetched
  page.replace(page.find(name_space), name_space.size(), "");
  for (const char* elsewhere : {"http:", "https:", "//www", " src=", " href=", "@import", "url(h",
                                "fetch(", "XMLHttpRequest", "import("})
    CHECK_FALSE(holds(page, elsewhere));
  CHECK(holds(page, "default-src 'none'"));
}

TEST_CASE("no name of the unit file can break out of the page") {
  report::DiagnosisRun run = sample_run(600);
  run.unit.unit = "</script><b>&";
  run.unit.cv[2].tag = "y\"3</script><!--";
  run.unit.mv[0].description = "\xff not UTF-8";
  const std::string page = page_of(run);
  CHECK(unbalanced(skeleton(page)).empty());
  const auto data = nlohmann::json::parse(between(page, "id=\"data\">", "</script>"));
  CHECK(data["report"]["unit"] == "</script><b>&");
  CHECK(data["cvs"][2]["tag"] == "y\"3</script><!--");
}

TEST_CASE("a long recording is thinned until the page is small") {
  const std::string page = page_of(sample_run(200'000));
  CHECK(page.size() < 5'000'000);
  const auto data = nlohmann::json::parse(between(page, "id=\"data\">", "</script>"));
  CHECK(data["cvs"][0]["sets"][0]["measured"].size() <= 4000);
}

TEST_CASE("a second recording has its own plots") {
  report::DiagnosisRun run = sample_run(600);
  run.validation = run.recording;
  run.diagnosis.validation_before = run.diagnosis.before;
  run.diagnosis.validation_after = run.diagnosis.after;
  const nlohmann::ordered_json data = report::page_data(run);
  CHECK(data["sets"].size() == 2);
  CHECK(data["sets"][0]["boundary"].is_null());
  CHECK(data["cvs"][1]["sets"][1]["after"].size() == 600);
}

TEST_CASE("a diagnosis without simulations still makes a page") {
  report::DiagnosisRun run = matching_run();
  run.diagnosis.before.resize(0, 0);
  run.diagnosis.after.resize(0, 0);
  run.diagnosis.scores.clear();
  CHECK(unbalanced(skeleton(page_of(run))).empty());
}

// For looking at: MPM_PAGE_FOLDER=/tmp diagnose_tests '[.page]'
TEST_CASE("write pages to look at", "[.page]") {
  const char* folder = std::getenv("MPM_PAGE_FOLDER");
  REQUIRE(folder != nullptr);
  const auto write = [&](const char* name, const report::DiagnosisRun& run) {
    std::ofstream(std::string(folder) + "/" + name) << report::page_html(report::page_data(run));
  };
  write("mismatch.html", sample_run());
  write("match.html", matching_run());
  write("long.html", sample_run(60'000));
  report::DiagnosisRun bent = sample_run();
  bent.diagnosis.extended.input_blocks[0] = Stiction{0.08, 0.03};
  bent.diagnosis.extended.input_blocks[1] = Polynomial{{0.8, 0.9}};
  bent.diagnosis.extended.output_blocks[2] = Saturation{-2.0, 2.5};
  write("bent.html", bent);
  report::DiagnosisRun dates = sample_run();
  dates.recording.start_s = 1767225600.0;
  dates.recording.sample_time_s = 60.0;
  dates.diagnosis.findings[2].onset_s = dates.recording.start_s + 2100.0 * 60.0;
  dates.validation = dates.recording;
  dates.validation_file = "next_week.csv";
  dates.diagnosis.validation_before = dates.diagnosis.before;
  dates.diagnosis.validation_after = dates.diagnosis.after;
  write("dates.html", dates);
}

}  // namespace
}  // namespace mpm::test
