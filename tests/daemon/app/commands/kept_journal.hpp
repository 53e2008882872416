#pragma once

#include <string>
#include <vector>

#include "daemon/history/alarm_store.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

/// A journal of two entries, and commands that read it.
struct Journal {
  TemporaryFolder folder;
  std::string path = folder.file("alarms.sqlite");

  Journal() {
    history::AlarmStore store(path, history::AlarmStore::Access::kAppend);
    history::AlarmEntry entry;
    entry.written_ns = 1'772'344'800'000'000'000;  // 2026-03-01 06:00 UTC
    entry.unit = "shell";
    entry.mv = "u1";
    entry.cv = "y1";
    entry.what = "active";
    entry.standing.annunciation = Annunciation::kUnacknowledged;
    store.append({entry});
    entry.written_ns += 3'600'000'000'000;
    entry.cv = "y2";
    entry.what = "cleared";
    store.append({entry});
  }
  int run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "mpm");
    arguments.insert(arguments.end(), {"--journal", path});
    Process process(arguments, folder.file("out"), folder.file("err"));
    return process.wait(std::chrono::seconds(20)).value_or(-1);
  }
  [[nodiscard]] std::string out() const { return read_file(folder.file("out")); }
};

}  // namespace mpm::test
