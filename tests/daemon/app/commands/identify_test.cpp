#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "config/load_unit.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::identify_test {
namespace {

/// Signals alone, with a comment that is to stay.
const std::string kUnit =
    "# Our heater.\nunit: heater\nsample_time: 2  # s\nsignals:\n  mv: [{tag: u, unit: \"%\"}, v]\n"
    "  cv: [{tag: y}]\nmonitor: {}\n";

/// y answers u with gain 2, time constant 16 s and dead time 2 s; v does nothing.
std::string rows(int count, bool moving = true, double level = 50.0) {
  std::string text = "time,u,v,y\n";
  double y = 0.0, last = 0.0, before = 0.0;
  unsigned state = 1;
  const auto draw = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8) / 16777216.0 - 0.5;
  };
  double u = 0.0, v = 0.0;
  for (int k = 0; k < count; ++k) {
    if (moving && k % 15 == 0) u = draw() > 0.0 ? 1.0 : -1.0;
    if (moving && k % 11 == 0) v = draw() > 0.0 ? 1.0 : -1.0;
    y += (1.0 - 0.8824969) * (2.0 * before - y);
    text += std::to_string(2 * k) + ',' + std::to_string(u) + ',' + std::to_string(v) + ',' +
            std::to_string(level + y + 0.1 * draw()) + '\n';
    before = last = u;
  }
  static_cast<void>(last);
  return text;
}

struct Bench {
  TemporaryFolder folder;

  Bench() {
    write_file(folder.file("unit.yaml"), kUnit);
    write_file(folder.file("a.csv"), rows(1500));
  }
  [[nodiscard]] int identify(std::vector<std::string> options) const {
    options.insert(options.begin(), {"mpm", "identify", "--config", folder.file("unit.yaml")});
    return run(options, folder.file("out"), folder.file("err")).value_or(-1);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    return read_file(folder.file(name));
  }
};

}  // namespace

TEST_CASE("mpm identify writes the unit file with the model that the data show") {
  const Bench bench;
  const std::string out = bench.folder.file("new.yaml"), report = bench.folder.file("report");
  REQUIRE(bench.identify({"--data", bench.folder.file("a.csv"), "--out", out, "--report", report,
                          "--json"}) == 0);
  const config::LoadResult back = config::load_unit(out);
  REQUIRE(back.ok());
  REQUIRE(back.config.model.channels.size() == 1);
  const auto& tf = std::get<TransferFunction>(back.config.model.channels[0].dynamics);
  // What rows() hides.
  CHECK(tf.gain == Approx(2.0).epsilon(0.05));
  CHECK(tf.time_constants_s.at(0) == Approx(16.0).epsilon(0.1));
  CHECK(back.config.model.output_origin(0) ==
        Approx(50.0 + 2.0 * back.config.model.input_origin(0)).margin(0.1));
  CHECK(bench.text("new.yaml").find("# Our heater.") == 0);
  CHECK(bench.text("new.yaml").find("sample_time: 2  # s") != std::string::npos);
  const auto json = nlohmann::json::parse(bench.text("out"));
  CHECK(json == nlohmann::json::parse(bench.text("report/model.json")));
  REQUIRE(json["channels"].size() == 2);
  CHECK(json["channels"][0]["in_model"] == true);
  CHECK(json["channels"][0]["step_response"]["values"].size() ==
        json["channels"][0]["step_response"]["sd"].size());
  CHECK(json["channels"][1]["reason"] == "no_relation");
}

TEST_CASE("a model that was there is replaced, and several files are runs of their own") {
  const Bench bench;
  write_file(
      bench.folder.file("unit.yaml"),
      kUnit + "model:\n  channels:\n  # of last year\n  - {cv: y, mv: v, gain: 9}\nalarms: {}\n");
  write_file(bench.folder.file("b.csv"), rows(1500, true, 80.0));
  const std::string out = bench.folder.file("new.yaml");
  REQUIRE(bench.identify({"--data", bench.folder.file("a.csv"), bench.folder.file("b.csv"), "--out",
                          out}) == 0);
  const config::LoadResult back = config::load_unit(out);
  REQUIRE(back.ok());
  REQUIRE(back.config.model.channels.size() == 1);
  CHECK(back.config.model.channels[0].input == 0);
  CHECK(bench.text("new.yaml").find("last year") == std::string::npos);
  CHECK(bench.text("new.yaml").find("alarms: {}") != std::string::npos);
  CHECK(bench.text("out").find("in 2 runs") != std::string::npos);
}

TEST_CASE("where nothing moves, nothing is written, and the plan says what to move") {
  const Bench bench;
  write_file(bench.folder.file("still.csv"), rows(600, false));
  const std::string out = bench.folder.file("new.yaml");
  CHECK(bench.identify({"--data", bench.folder.file("still.csv"), "--out", out, "--plan"}) == 1);
  CHECK_FALSE(std::filesystem::exists(out));
  CHECK(bench.text("out").find("u does not move") != std::string::npos);
  CHECK(bench.text("out").find("test plan") != std::string::npos);
  CHECK(bench.text("out").find("give it limits under `simulation`") != std::string::npos);
}

TEST_CASE("mpm identify refuses bad usage and bad input") {
  const Bench bench;
  CHECK(bench.identify({"--data", bench.folder.file("a.csv")}) == 3);  // nowhere to write
  CHECK(bench.identify({"--data", bench.folder.file("none.csv"), "--out", "x.yaml"}) == 3);
  write_file(bench.folder.file("unit.yaml"), kUnit + "identify: {channels: [{cv: y, mv: w}]}\n");
  CHECK(bench.identify({"--data", bench.folder.file("a.csv"), "--out", "x.yaml"}) == 3);
  CHECK(bench.text("err").find("unit.yaml:8:") != std::string::npos);
}

}  // namespace mpm::test::identify_test
