#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <sstream>

#include "daemon/report/unit_performance.hpp"
#include "idl/output_readers.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::same_answer_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

// The daemon judges what mpmsim publishes; detect judges what mpmsim writes with the same seed.
void check_same_answer(const std::string& scenario, const std::string& seed) {
  constexpr int kSamples = 900;
  constexpr int kChannels = 9;
  TemporaryFolder folder;
  const idl::DomainOptions domain = idl::test_domain("same_answer");
  const std::vector<std::string> simulate = {"mpmsim",       "--config",  kUnit,
                                             "--scenario",   scenario,    "--seed",
                                             seed,           "--samples", std::to_string(kSamples),
                                             "--start-time", "0"};

  std::vector<std::string> to_file = simulate;
  to_file.insert(to_file.end(), {"--csv", folder.file("run.csv")});
  REQUIRE(run(to_file, folder.file("sim.out"), folder.file("sim.err")) == 0);
  REQUIRE(run({"mpm", "detect", "--config", kUnit, "--data", folder.file("run.csv"),
               "--journal-every-sample", folder.file("detect.jsonl"), "--journal",
               folder.file("detect_journal")},
              folder.file("detect.out"), folder.file("detect.err")) == 0);

  Process daemon(
      {"mpmd", "--config", kUnit, "--partition", domain.partition, "--journal-every-sample",
       folder.file("live.jsonl"), "--journal", folder.file("live_journal")},
      folder.file("mpmd.out"), folder.file("mpmd.err"));
  std::vector<std::string> to_bus = simulate;
  to_bus.insert(to_bus.end(),
                {"--speed", "0", "--wait-readers", "20", "--partition", domain.partition});
  REQUIRE(run(to_bus, folder.file("bus.out"), folder.file("bus.err")) == 0);

  const std::string expected = read_file(folder.file("detect.jsonl"));
  REQUIRE(lines_of(expected).size() >= kSamples * kChannels);
  CHECK(idl::eventually(
      [&] { return read_file(folder.file("live.jsonl")).size() >= expected.size(); },
      std::chrono::seconds(20)));
  const bool identical = read_file(folder.file("live.jsonl")) == expected;
  CHECK(identical);  // byte for byte; not printed: megabytes
  daemon.send(SIGTERM);
  CHECK(daemon.wait(std::chrono::seconds(5)) == 0);

  // The journal that is kept as well, but for the health, of which a file knows nothing.
  std::string kept;
  for (const std::string& line :
       lines_of(read_file(folder.file("live_journal/shell-000001.jsonl"))))
    if (line.find("{\"record\":\"health\"") != 0) kept += line + "\n";
  CHECK(kept == read_file(folder.file("detect_journal/shell-000001.jsonl")));
  CHECK(kept.find("{\"record\":\"digest\"") != std::string::npos);

  const bool alarmed = expected.find("\"record\":\"alarm\"") != std::string::npos;
  CHECK(alarmed == (scenario != "none"));
}

TEST_CASE("mpm detect on a file and the daemon on DDS give the same bytes") {
  // Seed 5 of hidden_gain has its alarm within 900 samples; with nothing hidden there is none.
  check_same_answer("hidden_gain", "5");
  check_same_answer("none", "5");
}

// Predictions that the unit file names and nobody publishes are simulated, on the bus as on a file.
TEST_CASE("without predictions the daemon says what mpm detect says") {
  TemporaryFolder folder;
  const idl::DomainOptions domain = idl::test_domain("unpredicted");
  const auto must = [&](const std::vector<std::string>& command) {
    CAPTURE(command);
    REQUIRE(run(command, folder.file("out"), folder.file("err")) == 0);
  };
  must({"mpmsim", "--config", kUnit, "--scenario", "hidden_gain", "--seed", "5", "--samples", "900",
        "--start-time", "0", "--csv", folder.file("run.csv")});
  must({"mpm", "convert", folder.file("run.csv"), folder.file("run.mcap"), "--config", kUnit});
  Process daemon({"mpmd", "--config", kUnit, "--partition", domain.partition,
                  "--journal-every-sample", folder.file("live.jsonl")},
                 folder.file("mpmd.out"), folder.file("mpmd.err"));
  must({"mpm", "replay", folder.file("run.mcap"), "--topics", "mpm/mv", "mpm/cv", "--rate", "0",
        "--partition", domain.partition});

  const std::vector<std::string> rows = lines_of(read_file(folder.file("run.csv")));
  std::ofstream unpredicted(folder.file("unpredicted.csv"));
  std::vector<bool> kept;
  for (const std::string& row : rows) {
    if (row.empty() || row[0] == '#') continue;
    std::istringstream cells(row);
    std::string cell;
    for (std::size_t c = 0; std::getline(cells, cell, ','); ++c) {
      if (c == kept.size()) kept.push_back(cell.rfind("yhat", 0) != 0);  // the header
      if (kept[c]) unpredicted << (c == 0 ? "" : ",") << cell;
    }
    unpredicted << '\n';
  }
  unpredicted.close();
  must({"mpm", "detect", "--config", kUnit, "--data", folder.file("unpredicted.csv"),
        "--journal-every-sample", folder.file("detect.jsonl")});

  // The daemon still waits with the last intervals: what is missing there might come late.
  const std::vector<std::string> expected = lines_of(read_file(folder.file("detect.jsonl")));
  const auto settled = static_cast<std::ptrdiff_t>(expected.size()) - 9 * 10;
  std::vector<std::string> live;
  CHECK(idl::eventually(
      [&] {
        live = lines_of(read_file(folder.file("live.jsonl")));
        return static_cast<std::ptrdiff_t>(live.size()) >= settled;
      },
      std::chrono::seconds(20)));
  REQUIRE(live.size() <= expected.size());
  const bool identical = std::equal(live.begin(), live.end(), expected.begin());
  CHECK(identical);
  CHECK(expected.back().find("\"record\":\"channel\"") != std::string::npos);
  CHECK(std::any_of(live.begin(), live.end(), [](const std::string& line) {
    return line.find("\"verdict\":\"mismatch\"") != std::string::npos;
  }));
  daemon.send(SIGTERM);
  CHECK(daemon.wait(std::chrono::seconds(5)) == 0);
}

/// The same keys and texts, and numbers that differ by no more than the order of adding up.
void check_alike(const nlohmann::ordered_json& live, const nlohmann::ordered_json& file) {
  CAPTURE(live.dump(), file.dump());
  if (file.is_number_float()) {
    REQUIRE(live.is_number());
    CHECK(live.get<double>() == Approx(file.get<double>()).epsilon(1e-9));
  } else if (file.is_structured() && live.size() == file.size() && live.type() == file.type()) {
    for (auto mine = live.begin(), its = file.begin(); its != file.end(); ++mine, ++its)
      check_alike(*mine, *its);
  } else {
    CHECK(live == file);
  }
}

TEST_CASE("of control performance the daemon says what mpm detect says of the same frames") {
  TemporaryFolder folder;
  idl::DomainOptions domain = idl::test_domain("performance");
  domain.domain = 0;  // the unit file's
  const auto must = [&](const std::vector<std::string>& command) {
    CAPTURE(command);
    REQUIRE(run(command, folder.file("out"), folder.file("err")) == 0);
  };
  // 48 blocks of 20 samples: the 900 are 45 of them, and none has slid out.
  const std::string unit = folder.file("unit.yaml");
  std::string text = read_file(kUnit);
  text.replace(text.find("monitor: {}"), 11, "monitor: {performance_window: 960}");
  text.replace(text.find("{tag: u1,"), 9, "{tag: u1, low: -0.1, high: 0.1,");
  write_file(unit, text);
  const std::vector<std::string> simulate = {"mpmsim", "--config",     unit, "--scenario",
                                             "none",   "--seed",       "5",  "--samples",
                                             "900",    "--start-time", "0"};
  std::vector<std::string> to_file = simulate, to_bus = simulate;
  to_file.insert(to_file.end(), {"--csv", folder.file("run.csv")});
  must(to_file);
  must({"mpm", "detect", "--config", unit, "--data", folder.file("run.csv"), "--json"});
  const auto expected = nlohmann::ordered_json::parse(read_file(folder.file("out")))["performance"];
  REQUIRE(expected["samples"] == 900);

  Process daemon({"mpmd", "--config", unit, "--partition", domain.partition},
                 folder.file("mpmd.out"), folder.file("mpmd.err"));
  to_bus.insert(to_bus.end(),
                {"--speed", "0", "--wait-readers", "20", "--partition", domain.partition});
  must(to_bus);
  // Who joins late gets the last one; until the daemon is through that is an earlier one.
  const idl::Participant participant(domain);
  idl::OutputReaders readers(participant);
  PerformanceRecord last;
  CHECK(idl::eventually(
      [&] {
        for (const idl::Output& output : readers.take())
          if (const auto* record = std::get_if<PerformanceRecord>(&output)) last = *record;
        return last.samples == 900;
      },
      std::chrono::seconds(20)));
  CHECK(last.unit == "shell");
  CHECK(last.window_samples == 960);
  check_alike(report::performance_json(last), expected);
  daemon.send(SIGTERM);
  CHECK(daemon.wait(std::chrono::seconds(5)) == 0);
}

}  // namespace
}  // namespace mpm::test::same_answer_test
