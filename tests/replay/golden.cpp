// What the monitor says of fixed runs, compared with the files beside this one. A verdict or a
// diagnosis that moved must be agreed to: `./run bless` writes the files anew, and the diff goes
// with the change that moved it.
//
//   mpm_golden [--bless] [CASE|KIND...]   KIND: verdicts, diagnoses, recordings
//
// 0 all as before, 1 something moved, 2 failed, 77 nothing moved but something was skipped
#include <array>
#include <chrono>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/cases/recordings.hpp"
#include "tests/replay/diagnosis_text.hpp"
#include "tests/replay/stream.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

constexpr int kSkipped = 77;

/// A file that is kept in this folder, and what to print where it has moved.
struct Kept {
  std::string file;
  std::string text;
  std::string (*difference)(const std::string& before, const std::string& after);
};

struct Case {
  std::string kind;  ///< `verdicts`, `diagnoses` or `recordings`
  std::string name;
  std::string unit;  ///< file in config
  std::string data;  ///< a scenario, of `scenarios` here or of config, or a recording
  int seed = 0;
  int samples = 0;
  std::string unseen = {};  ///< a second recording, for validation; empty = none
};

const std::array kCases = {
    Case{"verdicts", "shell_nothing_hidden", "plants/shell3x3", "none", 1, 1800},
    Case{"verdicts", "shell_hidden_gain", "plants/shell3x3", "hidden_gain", 5, 1800},
    Case{"verdicts", "shell_wrong_dead_time", "plants/shell3x3", "s3_delay", 2, 1500},
    Case{"verdicts", "shell_change_and_back", "plants/shell3x3", "change_and_back", 3, 3000},
    Case{"verdicts", "shell_sticking_valve", "plants/shell3x3", "sticking_valve", 4, 1800},
    Case{"verdicts", "shell_bad_data", "plants/shell3x3", "bad_data", 6, 1800},
    Case{"verdicts", "shell_noise", "plants/shell3x3", "noise_x3", 7, 1800},
    Case{"verdicts", "wood_berry_nothing_hidden", "plants/wood_berry", "none", 8, 1500},
    Case{"verdicts", "tank_nothing_hidden", "plants/integrating_tank", "none", 9, 1500},

    Case{"diagnoses", "nothing_hidden", "plants/shell3x3", "none", 11, 2400},
    Case{"diagnoses", "hidden_gain", "plants/shell3x3", "hidden_gain", 12, 2400},
    Case{"diagnoses", "wrong_dead_time", "plants/shell3x3", "s3_delay", 13, 2400},
    Case{"diagnoses", "sticking_valve", "plants/shell3x3", "sticking_valve", 14, 2400},
    Case{"diagnoses", "unmodelled_input", "plants/shell3x3_ambient", "unmodelled_input", 15, 2400},
    Case{"diagnoses", "two_causes", "plants/shell3x3", "two_causes", 16, 2400},
    Case{"diagnoses", "wrong_actuator", "plants/shell3x3", "wrong_actuator", 17, 2400},
    Case{"diagnoses", "wrong_sensor", "plants/shell3x3", "wrong_sensor", 18, 2400},
    Case{"diagnoses", "slow_and_late", "plants/shell3x3", "slow_and_late", 19, 2400},
    Case{"diagnoses", "becomes_slow", "plants/shell3x3", "becomes_slow", 20, 1500},
    Case{"diagnoses", "bent_valve", "plants/shell3x3", "quadratic_valve", 21, 2400},
    Case{"diagnoses", "two_steps", "plants/shell3x3", "lagged_step", 22, 2400},
    Case{"diagnoses", "drifting_sensor", "plants/shell3x3", "ramp", 23, 2400},
    Case{"recordings", "heating_lamp", "cases/heating_lamp", "heating_lamp"},
    Case{"recordings", "cascaded_tanks", "cases/cascaded_tanks", "cascaded_tanks", 0, 0,
         "cascaded_tanks_val"},
};

void run_or_throw(const std::vector<std::string>& arguments, const TemporaryFolder& folder) {
  Process program(arguments, folder.file("out"), folder.file("err"));
  if (program.wait(std::chrono::minutes(10)) == 0) return;
  throw std::runtime_error(arguments[0] + " failed: " + read_file(folder.file("err")));
}

std::string unit_file(const Case& item) { return MPM_SOURCE_DIR "/config/" + item.unit + ".yaml"; }

void simulate(const Case& item, const TemporaryFolder& folder) {
  const std::string own = MPM_SOURCE_DIR "/tests/replay/scenarios/" + item.data + ".yaml";
  run_or_throw({"mpmsim", "--config", unit_file(item), "--scenario",
                std::filesystem::exists(own) ? own : item.data, "--seed", std::to_string(item.seed),
                "--samples", std::to_string(item.samples), "--csv", folder.file("run.csv")},
               folder);
}

std::vector<Kept> verdicts(const Case& item, const TemporaryFolder& folder) {
  simulate(item, folder);
  run_or_throw({"mpm", "detect", "--config", unit_file(item), "--data", folder.file("run.csv"),
                "--journal-every-sample", folder.file("journal.jsonl")},
               folder);
  return {{item.name + ".jsonl", condensed(read_file(folder.file("journal.jsonl"))), difference}};
}

std::string replaced(std::string text, const std::string& old_word, const std::string& new_word) {
  for (std::size_t at = text.find(old_word); at != std::string::npos;
       at = text.find(old_word, at + new_word.size()))
    text.replace(at, old_word.size(), new_word);
  return text;
}

/// Runs `work` inside a folder, so that what it writes can name files without their path.
void inside(const std::string& folder, const std::function<void()>& work) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  work();
  std::filesystem::current_path(before);
}

/// Of unit.yaml and run.csv in the folder, and unseen.csv where there is one.
std::vector<Kept> diagnosis(const Case& item, const TemporaryFolder& folder) {
  std::vector<std::string> command = {"mpm",    "diagnose", "--config", "unit.yaml",
                                      "--data", "run.csv",  "--out",    "report"};
  if (!item.unseen.empty()) command.insert(command.end(), {"--validate", "unseen.csv"});
  inside(folder.file(""), [&] { run_or_throw(command, folder); });

  const std::string report = read_file(folder.file("report/report.json"));
  const std::string version = nlohmann::json::parse(report)["made_by"]["program"];
  const auto without_version = [&](const std::string& text) {
    return replaced(text, version, "mpm");
  };
  const std::string page = read_file(folder.file("report/report.html"));
  const std::string extended = read_file(folder.file("report/extended.yaml"));
  const std::string place = "diagnoses/" + item.name + '/';
  return {{place + "report.json", without_version(laid_out(report)), json_difference},
          {place + "extended.yaml", without_version(extended), line_difference},
          {place + "page.json", condensed_page(without_version(page)), json_difference}};
}

/// False, and a loud word, where the recordings are not at hand.
bool take_recordings(const Case& item, const TemporaryFolder& folder) {
  static const Recordings recordings;
  for (const auto& [name, copy] : {std::pair(item.data, "run.csv"), {item.unseen, "unseen.csv"}}) {
    if (name.empty()) continue;
    const std::string file = recordings.find(name);
    if (file.empty()) {
      std::cout << recordings.skipped(name) << '\n';
      return false;
    }
    std::filesystem::copy_file(file, folder.file(copy));
  }
  return true;
}

/// Empty where the case was skipped.
std::vector<Kept> answer_now(const Case& item) {
  const TemporaryFolder folder;
  if (item.kind == "verdicts") return verdicts(item, folder);
  std::filesystem::copy_file(unit_file(item), folder.file("unit.yaml"));
  if (item.kind == "diagnoses")
    simulate(item, folder);
  else if (!take_recordings(item, folder))
    return {};
  return diagnosis(item, folder);
}

/// Whether it has moved.
bool compare(const Kept& kept, bool bless) {
  const std::string golden = MPM_SOURCE_DIR "/tests/replay/" + kept.file;
  const std::string before = read_file(golden);
  if (before == kept.text) return false;
  std::cout << kept.file << (bless ? ": written anew\n" : ": moved\n")
            << (before.empty() ? "  there was none before\n" : kept.difference(before, kept.text));
  if (bless) {
    std::filesystem::create_directories(std::filesystem::path(golden).parent_path());
    write_file(golden, kept.text);
  }
  return true;
}

int compare_all(bool bless, const std::set<std::string>& chosen) {
  int moved = 0, skipped = 0;
  for (const Case& item : kCases) {
    if (!chosen.empty() && chosen.count(item.name) + chosen.count(item.kind) == 0) continue;
    const std::vector<Kept> answer = answer_now(item);
    if (answer.empty()) ++skipped;
    for (const Kept& kept : answer)
      if (compare(kept, bless)) ++moved;
  }
  if (moved == 0) {
    std::cout << "all as before\n";
  } else if (!bless) {
    std::cout << moved << " moved; if that is right, accept it with: ./run bless\n";
  }
  if (skipped > 0) std::cout << skipped << " SKIPPED\n";
  if (bless) return 0;
  return moved > 0 ? 1 : skipped > 0 ? kSkipped : 0;
}

}  // namespace
}  // namespace mpm::test

int main(int argc, char** argv) {
  try {
    std::set<std::string> chosen(argv + 1, argv + argc);
    const bool bless = chosen.erase("--bless") > 0;
    return mpm::test::compare_all(bless, chosen);
  } catch (const std::exception& error) {
    std::cerr << "mpm_golden: " << error.what() << '\n';
    return 2;
  }
}
