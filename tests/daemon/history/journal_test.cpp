#include "daemon/history/journal.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "daemon/history/read_journal.hpp"
#include "tests/daemon/history/full_disk.hpp"
#include "tests/daemon/history/sample_history.hpp"
#include "tests/system/process.hpp"

namespace mpm::history {
namespace {

std::vector<nlohmann::json> lines_of(const std::string& path) {
  std::vector<nlohmann::json> lines;
  for (const std::string& line : test::lines_of(test::read_file(path)))
    lines.push_back(nlohmann::json::parse(line));
  return lines;
}

std::int64_t digested(const std::vector<nlohmann::json>& lines) {
  std::int64_t samples = 0;
  for (const auto& line : lines)
    if (line["record"] == "digest") samples += line["samples"].get<std::int64_t>();
  return samples;
}

/// A run whose gain is 1.4 times the model's from sample 2000 on.
void run(Journal& journal, int samples) {
  report::UnitMonitor monitor(test::minute_unit());
  test::MinuteFrames frames;
  for (int k = 0; k < samples; ++k) {
    if (k == 2000) frames.set_ratio(1.4);
    monitor.push(frames.next());
    journal.push(monitor);
  }
  journal.finish();
}

TEST_CASE("a journal has each change at its sample, and digests of all samples") {
  const test::TemporaryFolder folder;
  Journal journal(test::minute_unit(), {folder.file("j"), "minute", 1'000'000'000});
  run(journal, 4000);
  const auto lines = lines_of(folder.file("j") + "/minute-000001.jsonl");
  CHECK(lines.at(0)["record"] == "journal");
  CHECK(lines.at(1)["record"] == "channel");
  CHECK(digested(lines) == 4000);

  // The same run, said by the monitor sample by sample.
  report::UnitMonitor monitor(test::minute_unit());
  test::MinuteFrames frames;
  std::vector<std::pair<std::int64_t, std::string>> changes, alarms, written, written_alarms;
  std::string before;
  for (int k = 0; k < 4000; ++k) {
    if (k == 2000) frames.set_ratio(1.4);
    monitor.push(frames.next());
    const ChannelRecord& channel = monitor.channels()[0];
    const std::string now = std::string(to_string(channel.verdict)) + "," +
                            std::string(to_string(channel.reason)) + "," +
                            std::string(to_string(channel.alarm));
    if (now != before) changes.emplace_back(k, now);
    before = now;
    for (const AlarmRecord& alarm : monitor.alarms())
      alarms.emplace_back(k, std::string(to_string(alarm.to)));
  }
  for (const auto& line : lines) {
    if (line["record"] == "channel")
      written.emplace_back(line["interval"], line["verdict"].get<std::string>() + "," +
                                                 line.value("reason", "") + "," +
                                                 line["alarm"].get<std::string>());
    if (line["record"] == "alarm")
      written_alarms.emplace_back(line["interval"], line["to"].get<std::string>());
  }
  CHECK(written == changes);
  CHECK(written_alarms == alarms);
  CHECK_FALSE(alarms.empty());
  CHECK(changes.size() < 60);
}

TEST_CASE("each file of a journal can be read alone") {
  const test::TemporaryFolder folder;
  Journal journal(test::minute_unit(), {folder.file("j"), "minute", 160'000});  // 10 kB each
  run(journal, 4000);
  std::size_t files = 0;
  std::int64_t samples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("j"))) {
    CAPTURE(entry.path());
    ++files;
    const auto lines = lines_of(entry.path().string());
    REQUIRE(lines.size() > 2);
    CHECK(lines[0]["record"] == "journal");
    const auto channel = std::find_if(lines.begin(), lines.begin() + 3,
                                      [](const auto& line) { return line["record"] == "channel"; });
    CHECK(channel != lines.begin() + 3);
    samples += digested(lines);
  }
  CHECK(files > 5);
  CHECK(samples == 4000);
}

TEST_CASE("after trouble with the disk a journal goes on with all channels as they stand") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("j") + "/minute-000001.jsonl";
  report::UnitMonitor monitor(test::minute_unit());
  test::MinuteFrames frames;
  Journal journal(test::minute_unit(), {folder.file("j"), "minute", 1'000'000'000});
  const auto push = [&](int samples) {
    for (int k = 0; k < samples; ++k) {
      monitor.push(frames.next());
      journal.push(monitor);
    }
  };
  push(1000);
  const std::size_t before = lines_of(path).size();
  {
    const test::FullDisk full(std::filesystem::file_size(path));
    push(100);
    CHECK_FALSE(journal.problem().empty());
  }
  push(1);
  CHECK(journal.problem().empty());
  const auto lines = lines_of(path);  // each is whole
  REQUIRE(lines.size() > before);
  CHECK(lines.back()["record"] == "channel");
  CHECK(lines.back()["interval"] == 1100);
}

TEST_CASE("the health is written when its state changes") {
  const test::TemporaryFolder folder;
  Journal journal(test::minute_unit(), {folder.file("j"), "minute", 1'000'000'000});
  HealthRecord health;
  health.state = "function_check";
  journal.push(health);  // nothing came yet
  run(journal, 10);
  for (const char* state : {"function_check", "function_check", "normal", "failure", "failure"}) {
    health.state = state;
    journal.push(health);
  }
  std::vector<std::string> states;
  for (const auto& line : lines_of(folder.file("j") + "/minute-000001.jsonl"))
    if (line["record"] == "health") states.push_back(line["state"]);
  CHECK(states == std::vector<std::string>{"function_check", "normal", "failure"});
}

}  // namespace
}  // namespace mpm::history
