#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/system/process.hpp"

namespace mpm::test::trend_test {
namespace {

using Json = nlohmann::json;

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/wood_berry.yaml";
constexpr const char* kStart = "2026-01-05T00:00:00Z";  // a Monday
constexpr int kWeek = 7 * 1440;                         // samples

// More by hand: `MPM_RUNS=300 build/release/tests/command_tests '*chance*'`.
int runs(int by_default) {
  const char* text = std::getenv("MPM_RUNS");
  return text == nullptr ? by_default : std::max(1, std::atoi(text));
}

struct History {
  TemporaryFolder folder;

  [[nodiscard]] std::string file(const std::string& name) const { return folder.file(name); }
  [[nodiscard]] int run(const std::vector<std::string>& arguments) const {
    return test::run(arguments, file("out"), file("err")).value_or(-1);
  }
  void simulate(const std::string& scenario, int samples, int seed, const std::string& name) const {
    REQUIRE(run({"mpmsim", "--config", kUnit, "--scenario", scenario, "--samples",
                 std::to_string(samples), "--seed", std::to_string(seed), "--start-time", kStart,
                 "--csv", file(name)}) == 0);
  }
  [[nodiscard]] int trend(std::vector<std::string> options) const {
    options.insert(options.begin(), {"mpm", "trend"});
    return run(options);
  }
  [[nodiscard]] Json of_data(const std::string& name, const std::string& by) const {
    REQUIRE(trend({"--config", kUnit, "--data", file(name), "--by", by, "--json"}) == 0);
    return Json::parse(read_file(file("out")));
  }
  [[nodiscard]] std::string out() const { return read_file(file("out")); }
  [[nodiscard]] std::string err() const { return read_file(file("err")); }
};

/// The change of a gain that is told of a channel; null where none is.
Json change_of(const Json& trend, const std::string& mv, const std::string& cv) {
  for (const Json& change : trend["changes"])
    if (change["what"] == "gain" && change["mv"] == mv && change["cv"] == cv) return change;
  return {};
}

/// Of weeks since the start.
double weeks(const Json& since) { return (since.get<double>() - 1767571200.0) / (7 * 86400.0); }

TEST_CASE("a gain that decays over weeks is found, in its channel and with its week", "[trials]") {
  const History history;
  std::string scenario = "changes:\n";
  for (int week = 3; week < 9; ++week)  // 4 % a week from week 3 on
    scenario += "  - {cv: xd, mv: reflux, gain_ratio: " + std::to_string(1.0 - 0.04 * (week - 2)) +
                ", from: " + std::to_string(week * kWeek) + " samples" +
                (week < 8 ? ", until: " + std::to_string((week + 1) * kWeek) + " samples" : "") +
                "}\n";
  write_file(history.file("decay.yaml"), scenario);
  history.simulate(history.file("decay.yaml"), 9 * kWeek, 2, "decay.csv");
  const std::string by = GENERATE("week", "day");
  const Json trend = history.of_data("decay.csv", by);
  const Json decay = change_of(trend, "reflux", "xd");
  REQUIRE(decay.is_object());
  CHECK(decay["gradual"] == true);
  CHECK(weeks(decay["since"]) >= 2.0);  // hidden from week 3 on
  CHECK(weeks(decay["since"]) <= 4.0);
  CHECK(decay["interval"][0] < -24.0);
  CHECK(decay["interval"][1] > -24.0);
  CHECK(std::abs(decay["before"].get<double>()) < 5.0);
  for (const Json& change : trend["changes"]) CHECK(change["cv"] == "xd");  // xb did not change
  if (by == "week") return;  // of errors that grow along no line nine weeks do not tell
  CHECK(trend["changes"][0]["what"] == "prediction_error");
  CHECK(trend["changes"][0]["now"] > 3.0);
  CHECK(weeks(trend["changes"][0]["since"]) >= 2.0);
  CHECK(weeks(trend["changes"][0]["since"]) <= 4.0);
}

TEST_CASE("a gain that jumps is told with the moment of its alarm", "[trials]") {
  const History history;
  write_file(history.file("jump.yaml"),
             "changes:\n  - {cv: xb, mv: steam, gain_ratio: 0.7, from: 20160 samples}\n");
  history.simulate(history.file("jump.yaml"), 4 * kWeek, 3, "jump.csv");
  const Json trend = history.of_data("jump.csv", "day");
  const Json jump = change_of(trend, "steam", "xb");
  REQUIRE(jump.is_object());
  CHECK(jump["gradual"] == false);
  CHECK(weeks(jump["since"]) >= 2.0);  // the alarm cannot be before it
  CHECK(weeks(jump["since"]) <= 2.0 + 1.0 / 7.0);
  CHECK(jump["text"].get<std::string>().find(" January; was within 5 % before") !=
        std::string::npos);
  for (const Json& change : trend["changes"]) CHECK(change["cv"] == "xb");
}

// The stated rate is 1 of 100 histories; of a few none.
TEST_CASE("of healthy histories nothing is told beyond chance", "[trials]") {
  const History history;
  const int count = runs(4);
  int told = 0;
  for (int seed = 1; seed <= count; ++seed) {
    history.simulate("none", 4 * kWeek, seed, "healthy.csv");
    const Json trend = history.of_data("healthy.csv", "day");
    CHECK(trend["periods"].size() == 28);
    CHECK(trend["cannot_tell"].empty());
    told += trend["changes"].empty() ? 0 : 1;
  }
  CAPTURE(told, count);
  CHECK(told <= 0.01 * count + 2.0 * std::sqrt(0.01 * count));
}

// The negative control: what is larger is the noise, and no gain is blamed for it.
TEST_CASE("noise that grows is told of the prediction errors, with its day and size", "[trials]") {
  const History history;
  history.simulate("noise_x3", 4 * kWeek, 1, "noise.csv");  // from the middle of the run on
  const Json trend = history.of_data("noise.csv", "day");
  REQUIRE(trend["changes"].size() == 2);
  for (const Json& change : trend["changes"]) {
    CHECK(change["what"] == "prediction_error");
    CHECK(weeks(change["since"]) == Approx(2.0).margin(1.01 / 7.0));
    CHECK(change["now"].get<double>() == Approx(3.0).margin(0.4));
  }
}

TEST_CASE("the trend of data and that of the journal of the same data agree", "[trials]") {
  const History history;
  write_file(history.file("jump.yaml"),
             "changes:\n  - {cv: xb, mv: steam, gain_ratio: 0.7, from: 20160 samples}\n");
  history.simulate(history.file("jump.yaml"), 4 * kWeek, 3, "jump.csv");
  REQUIRE(history.run({"mpm", "detect", "--config", kUnit, "--data", history.file("jump.csv"),
                       "--journal", history.file("journal")}) == 0);
  for (const std::string form : {"", "--json"}) {
    std::vector<std::string> data{"--config", kUnit,
                                  "--data",   history.file("jump.csv"),
                                  "--csv",    history.file("data.csv"),
                                  "--svg",    history.file("data.svg")};
    std::vector<std::string> journal{"--journal", history.file("journal"),
                                     "--csv",     history.file("journal.csv"),
                                     "--svg",     history.file("journal.svg")};
    if (!form.empty()) {
      data.push_back(form);
      journal.push_back(form);
    }
    REQUIRE(history.trend(data) == 0);
    const std::string said = history.out();
    REQUIRE(history.trend(journal) == 0);
    CHECK(history.out() == said);
    CHECK(said.find("steam -> xb") != std::string::npos);
  }
  CHECK(read_file(history.file("journal.csv")) == read_file(history.file("data.csv")));
  REQUIRE(history.trend({"--journal", history.file("journal"), "--csv", "-"}) == 0);
  CHECK(history.out() == read_file(history.file("data.csv")));
  CHECK(read_file(history.file("journal.svg")) == read_file(history.file("data.svg")));
  CHECK(history.trend({"--journal", history.file("journal"), "--fail-on-mismatch"}) == 1);
}

TEST_CASE("several data files give the trend of one", "[trials]") {
  const History history;
  history.simulate("none", 2 * kWeek, 4, "whole.csv");
  const std::vector<std::string> lines = lines_of(read_file(history.file("whole.csv")));
  std::string head, first, second;
  std::size_t row = 0;
  for (const std::string& line : lines) {
    const bool data = line.rfind("2026", 0) == 0;
    (data ? (row < static_cast<std::size_t>(kWeek) ? first : second) : head) += line + "\n";
    row += data ? 1 : 0;
  }
  write_file(history.file("1.csv"), head + first);
  write_file(history.file("2.csv"), head + second);
  REQUIRE(history.trend({"--config", kUnit, "--data", history.file("whole.csv"), "--json"}) == 0);
  const std::string whole = history.out();
  REQUIRE(history.trend({"--config", kUnit, "--data", history.file("2.csv"), history.file("1.csv"),
                         "--json"}) == 0);
  CHECK(history.out() == whole);
}

TEST_CASE("mpm trend refuses what makes no trend") {
  const History history;
  history.simulate("none", 200, 1, "short.csv");
  CHECK(history.trend({"--config", kUnit}) == 3);
  CHECK(history.trend({"--data", history.file("short.csv")}) == 3);
  CHECK(history.trend({"--config", kUnit, "--data", history.file("short.csv"), "--by", "year"}) ==
        3);
  CHECK(history.trend({"--config", kUnit, "--data", history.file("none.csv")}) == 3);
  CHECK(history.err().find(history.file("none.csv") + ": error: ") == 0);
  CHECK(history.trend({"--journal", history.file("none")}) == 3);
  CHECK(history.trend({"--config", kUnit, "--data", history.file("short.csv"), "--from",
                       "2027-01-01T00:00:00Z"}) == 3);
  CHECK(history.err().find("in the time chosen") != std::string::npos);
  write_file(history.file("bad.jsonl"), "{\"record\":\"journal\",\n");
  CHECK(history.trend({"--journal", history.file("bad.jsonl")}) == 3);
  CHECK(history.err().find(history.file("bad.jsonl") + ":1:") == 0);

  REQUIRE(history.trend({"--config", kUnit, "--data", history.file("short.csv"), "--svg",
                         "/no/such/folder/x.svg"}) == 3);
  REQUIRE(history.trend({"--config", kUnit, "--data", history.file("short.csv")}) == 0);
  CHECK(history.out().find("Cannot tell") != std::string::npos);
  CHECK(history.out().find("too few samples yet") != std::string::npos);
}

}  // namespace
}  // namespace mpm::test::trend_test
