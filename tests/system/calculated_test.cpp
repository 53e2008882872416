#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::calculated_test {
namespace {

constexpr int kSamples = 1500;

/// Nobody measures the CV: it is computed from what is measured.
const std::string kUnit =
    "unit: heater\nsample_time: 10\nsignals:\n"
    "  mv: [{tag: valve, unit: \"%\"}]\n"
    "  cv: [{tag: heat, unit: kW}]\n"
    "  raw: [{tag: flow, unit: kg/s}, {tag: T_supply, unit: K}, {tag: TI-102.PV, unit: K}]\n"
    "  calc:\n"
    "    heat: 4.19 * flow * rise\n"
    "    rise: {expression: \"T_supply - {TI-102.PV}\", unit: K}\n";
const std::string kModel =
    "model: {channels: [{cv: heat, mv: valve, gain: 2, time_constants: [60], dead_time: 20}]}\n"
    "operating_point: {valve: 50, heat: 500}\n";

/// The heat answers the valve with `gain`, time constant 60 s and two samples of dead time; flow
/// and return temperature wander, and the supply is what the heat makes of them.
std::string rows(double gain) {
  std::string text = "time,valve,flow,T_supply,TI-102.PV\n";
  unsigned state = 7;
  const auto draw = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8) / 16777216.0 - 0.5;
  };
  double valve = 0.0, late[2] = {0.0, 0.0}, lag = 0.0, flow = 3.0, back = 320.0;
  for (int k = 0; k < kSamples; ++k) {
    lag += (1.0 - 0.8464817) * (gain * late[1] - lag);  // exp(-10 / 60)
    late[1] = late[0];
    late[0] = valve;
    if (k % 12 == 0) valve = draw() > 0.0 ? 5.0 : -5.0;
    flow += 0.1 * (3.0 - flow) + 0.2 * draw();
    back += 0.05 * (320.0 - back) + draw();
    const double heat = 500.0 + lag + 1.0 * draw();
    char line[160];
    const bool bad = k % 200 == 150;  // a sensor that fails now and then
    std::snprintf(line, sizeof line, "%d,%.10g,%.10g,%s,%.10g\n", 10 * k, 50.0 + valve, flow,
                  bad ? "Bad" : std::to_string(back + heat / (4.19 * flow)).c_str(), back);
    text += line;
  }
  return text;
}

struct Bench {
  TemporaryFolder folder;

  void must(const std::vector<std::string>& command) const {
    CAPTURE(command);
    const auto code = run(command, folder.file("out"), folder.file("err"));
    INFO(read_file(folder.file("err")));
    REQUIRE(code == 0);
  }
  [[nodiscard]] nlohmann::json detect(const std::string& unit, const std::string& data) const {
    must({"mpm", "detect", "--config", folder.file(unit), "--data", folder.file(data), "--json",
          "--journal-every-sample", folder.file(data + ".jsonl")});
    return nlohmann::json::parse(read_file(folder.file("out")));
  }
};

}  // namespace

TEST_CASE("a CV that is calculated is judged the same from a file, a recording and the bus") {
  const Bench bench;
  const TemporaryFolder& folder = bench.folder;
  write_file(folder.file("unit.yaml"), kUnit + kModel);
  write_file(folder.file("run.csv"), rows(3.0));
  const nlohmann::json said = bench.detect("unit.yaml", "run.csv");
  CHECK(said["channels"][0]["verdict"] == "mismatch");
  CHECK(said["channels"][0]["effect_size"].get<double>() == Approx(1.0).margin(0.2));

  bench.must({"mpm", "convert", folder.file("run.csv"), folder.file("run.mcap"), "--config",
              folder.file("unit.yaml")});
  CHECK(bench.detect("unit.yaml", "run.mcap") == said);
  const std::string expected = read_file(folder.file("run.csv.jsonl"));
  REQUIRE(lines_of(expected).size() >= kSamples);
  const bool same_in_recording = read_file(folder.file("run.mcap.jsonl")) == expected;
  CHECK(same_in_recording);

  const idl::DomainOptions domain = idl::test_domain("calculated");
  Process daemon({"mpmd", "--config", folder.file("unit.yaml"), "--partition", domain.partition,
                  "--journal-every-sample", folder.file("live.jsonl")},
                 folder.file("mpmd.out"), folder.file("mpmd.err"));
  bench.must(
      {"mpm", "replay", folder.file("run.mcap"), "--rate", "0", "--partition", domain.partition});
  CHECK(idl::eventually(
      [&] { return read_file(folder.file("live.jsonl")).size() >= expected.size(); },
      std::chrono::seconds(20)));
  const bool same_on_the_bus = read_file(folder.file("live.jsonl")) == expected;
  CHECK(same_on_the_bus);
  daemon.send(SIGTERM);
  CHECK(daemon.wait(std::chrono::seconds(5)) == 0);
}

TEST_CASE("a model of a calculated CV is identified from its measurements and then holds") {
  const Bench bench;
  const TemporaryFolder& folder = bench.folder;
  write_file(folder.file("unit.yaml"), kUnit);
  write_file(folder.file("run.csv"), rows(3.0));
  bench.must({"mpm", "identify", "--config", folder.file("unit.yaml"), "--data",
              folder.file("run.csv"), "--out", folder.file("new.yaml"), "--json"});
  const std::string written = read_file(folder.file("new.yaml"));
  CHECK(written.find("heat: 4.19 * flow * rise") != std::string::npos);
  CHECK(bench.detect("new.yaml", "run.csv")["channels"][0]["verdict"] == "match");

  // The other way: with the model of another gain it does not.
  write_file(folder.file("other.yaml"), kUnit + kModel);
  CHECK(bench.detect("other.yaml", "run.csv")["channels"][0]["verdict"] == "mismatch");
  // The heat itself, for a spreadsheet.
  bench.must({"mpm", "convert", folder.file("run.csv"), folder.file("heat.csv"), "--config",
              folder.file("other.yaml"), "--time-zone", "seconds"});
  const std::vector<std::string> lines = lines_of(read_file(folder.file("heat.csv")));
  REQUIRE(lines.size() == kSamples + 1);
  CHECK(lines[0].find("time,valve,heat,") == 0);
  CHECK(lines[0].find("flow,T_supply,TI-102.PV") != std::string::npos);
  const auto numbers = [](const std::string& line) {
    std::vector<double> values;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');)
      if (!cell.empty() && cell.find_first_not_of("0123456789.e-") == std::string::npos)
        values.push_back(std::stod(cell));
    return values;
  };
  const std::vector<double> row = numbers(lines[1]);
  REQUIRE(row.size() == 6);  // time, valve, heat, flow and two temperatures
  CHECK(row[2] == Approx(4.19 * row[3] * (row[4] - row[5])));
  CHECK(row[2] == Approx(500.0).margin(2.0));

  // Without the measurements it is said what for they are wanted.
  write_file(folder.file("short.csv"), "time,valve,flow,heat\n0,50,3,500\n10,50,3,500\n");
  CHECK(run({"mpm", "detect", "--config", folder.file("other.yaml"), "--data",
             folder.file("short.csv")},
            folder.file("out"), folder.file("err")) == 3);
  CHECK(read_file(folder.file("err")).find("what 'rise' is calculated from, 'T_supply'") !=
        std::string::npos);
}

}  // namespace mpm::test::calculated_test
