// What the monitor says of fixed runs, compared with the files beside this one. A verdict that
// moved must be agreed to: `./run bless` writes the files anew, and the diff goes with the change
// that moved it.
//
//   mpm_golden [--bless] [CASE...]       0 all as before, 1 something moved, 2 failed
#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <iostream>
#include <set>
#include <stdexcept>

#include "tests/replay/stream.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

struct Case {
  const char* name;
  const char* plant;
  const char* scenario;
  int seed;
  int samples;
};

constexpr std::array kCases = {
    Case{"shell_nothing_hidden", "shell3x3", "none", 1, 1800},
    Case{"shell_hidden_gain", "shell3x3", "hidden_gain", 5, 1800},
    Case{"shell_wrong_dead_time", "shell3x3", "s3_delay", 2, 1500},
    Case{"shell_change_and_back", "shell3x3", "change_and_back", 3, 3000},
    Case{"shell_sticking_valve", "shell3x3", "sticking_valve", 4, 1800},
    Case{"shell_bad_data", "shell3x3", "bad_data", 6, 1800},
    Case{"shell_noise", "shell3x3", "noise_x3", 7, 1800},
    Case{"wood_berry_nothing_hidden", "wood_berry", "none", 8, 1500},
    Case{"tank_nothing_hidden", "integrating_tank", "none", 9, 1500},
};

std::string golden_file(const Case& item) {
  return MPM_SOURCE_DIR "/tests/replay/" + std::string(item.name) + ".jsonl";
}

void run_or_throw(const std::vector<std::string>& arguments, const TemporaryFolder& folder) {
  if (run(arguments, folder.file("out"), folder.file("err")) == 0) return;
  throw std::runtime_error(arguments[0] + " failed: " + read_file(folder.file("err")));
}

std::string answer_now(const Case& item) {
  const TemporaryFolder folder;
  const std::string unit = MPM_SOURCE_DIR "/config/plants/" + std::string(item.plant) + ".yaml";
  run_or_throw(
      {"mpmsim", "--config", unit, "--scenario", item.scenario, "--seed", std::to_string(item.seed),
       "--samples", std::to_string(item.samples), "--csv", folder.file("run.csv")},
      folder);
  run_or_throw({"mpm", "detect", "--config", unit, "--data", folder.file("run.csv"), "--journal",
                folder.file("journal.jsonl")},
               folder);
  return condensed(read_file(folder.file("journal.jsonl")));
}

int compare(bool bless, const std::set<std::string>& chosen) {
  int moved = 0;
  for (const Case& item : kCases) {
    if (!chosen.empty() && chosen.count(item.name) == 0) continue;
    const std::string before = read_file(golden_file(item)), now = answer_now(item);
    if (before == now) continue;
    ++moved;
    std::cout << item.name << (bless ? ": written anew\n" : ": moved\n")
              << (before.empty() ? "  there was none before\n" : difference(before, now));
    if (bless) write_file(golden_file(item), now);
  }
  if (moved == 0) {
    std::cout << "all as before\n";
  } else if (!bless) {
    std::cout << moved << " moved; if that is right, accept it with: ./run bless\n";
  }
  return moved > 0 && !bless ? 1 : 0;
}

}  // namespace
}  // namespace mpm::test

int main(int argc, char** argv) {
  try {
    std::set<std::string> chosen(argv + 1, argv + argc);
    const bool bless = chosen.erase("--bless") > 0;
    return mpm::test::compare(bless, chosen);
  } catch (const std::exception& error) {
    std::cerr << "mpm_golden: " << error.what() << '\n';
    return 2;
  }
}
