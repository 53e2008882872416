#include "tests/boiler/story.hpp"

#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cerrno>

#include "config/load_unit.hpp"
#include "daemon/report/page/page.hpp"
#include "tests/boiler/page_data.hpp"
#include "tests/boiler/tables.hpp"
#include "tests/boiler/unit_texts.hpp"
#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

/// What the page holds for its script.
Json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

StoryPlan short_plan() {
  StoryPlan plan;
  plan.rest = 60;
  plan.test = 2700;
  plan.compare = 300;
  plan.watch = 900;
  plan.others = {"o2_analyser_drift"};
  return plan;
}

TEST_CASE(
    "a short story of the boiler becomes a page, and the monitor says the same live and after") {
  const test::TemporaryFolder folder;
  Workshop workshop(folder.file("work"));
  const Story story = play(workshop, short_plan());
  for (const LiveRun* run : {&story.commissioned, &story.mismatch, &story.repaired, &story.healthy,
                             &story.changed, &story.others.at(0).run}) {
    CAPTURE(run->recording);
    CHECK(run->same_answer);
    CHECK(run->detect["channels"].size() == 16);
  }
  CHECK(alarms_said(story.healthy.detect) == "none");
  CHECK((waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD));  // no process is left

  const std::string page = report::page_html(page_data(story));
  CHECK(page.size() < 3'000'000);
  const Json data = data_of(page);
  REQUIRE(data["chapters"].size() == 7);
  for (const Json& chapter : data["chapters"]) {
    CAPTURE(chapter["title"]);
    CHECK_FALSE(chapter["text"].empty());
    CHECK_FALSE(chapter["made"].empty());
  }
  CHECK(data["chapters"][1]["plots"].size() == 16);  // figure 5.2
  for (const std::size_t figures : {2U, 3U, 5U})     // 5.3 and 5.4, 5.5 and 5.6, repaired
    CHECK(data["chapters"][figures]["groups"].size() == 2);
  // Table 5.6 has numbers throughout.
  for (const Json& row : data["chapters"][5]["tables"][0]["rows"])
    for (const Json& cell : row) CHECK(cell != "\u2013");

  test::write_file("page.html", page);
  const auto drawn = test::run({MPM_SOURCE_DIR "/tests/daemon/report/page/browser/check_story.sh",
                                MPM_BIN_DIR "/..", MPM_SOURCE_DIR, folder.file("work/page.html")},
                               "browser.out", "browser.err");
  INFO(test::read_file("browser.err"));
  CHECK((drawn == 0 || drawn == 77));  // 77: there is no browser
}

TEST_CASE("a test signal stays within the limits of what it moves") {
  const std::string scenario = MPM_SOURCE_DIR "/config/plants/scenarios/identification.yaml";
  const std::string plant = MPM_SOURCE_DIR "/config/plants/recovery_boiler.yaml";
  // By hand from its limits and sizes: 125 to 145 m3/h and 2, 125 to 135 degC and 2, 15 to 45 m3/s
  // and 3; the spray valve's place leaves room.
  const auto unit =
      config::load_unit_text(resting_at(plant, {16.0, 150.0, 134.0, 31.0}, scenario), "now");
  REQUIRE(unit.ok());
  const Eigen::VectorXd& at = unit.config.model.input_origin;
  CHECK(at(0) == 18.0);
  CHECK(at(1) == 143.0);
  CHECK(at(2) == 133.0);
  CHECK(at(3) == 31.0);
}

TEST_CASE("a unit without its model keeps its signals, and a part of it its own") {
  const std::string whole = test::read_file(MPM_SOURCE_DIR "/config/plants/recovery_boiler.yaml");
  const std::string tags = tags_alone(whole);
  CHECK(tags.find("gain:") == std::string::npos);
  CHECK(tags.find("simulation:") != std::string::npos);
  const std::string part = tags_alone(whole, {"AI-602.PV"});
  CHECK(part.find("{tag: AI-602.PV") != std::string::npos);
  CHECK(part.find("{tag: FI-500.PV") == std::string::npos);
  CHECK(part.find("{tag: FC-301.SP") != std::string::npos);
}

}  // namespace
}  // namespace mpm::boiler
