#include "daemon/live/alarm_journal.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/system/process.hpp"

namespace mpm::live {
namespace {

history::AlarmEntry entry(int number) {
  history::AlarmEntry entry;
  entry.written_ns = number;
  entry.unit = "shell";
  entry.what = std::to_string(number);
  entry.standing.out_of_service = true;
  return entry;
}

std::size_t entries(const std::string& path) {
  return history::AlarmStore(path, history::AlarmStore::Access::kRead).verify().entries;
}

TEST_CASE("all that was pushed is written before the journal goes") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alarms.sqlite");
  {
    AlarmJournal journal(path);
    for (int i = 0; i < 1000; ++i) journal.push(entry(i));
    CHECK(journal.problem().empty());
  }
  CHECK(entries(path) == 1000);
  AlarmJournal journal(path);
  REQUIRE(journal.before("shell").size() == 1);
  CHECK(journal.before("shell")[0].what == "999");
  CHECK(journal.before("shell")[0].standing.out_of_service);
}

TEST_CASE("what cannot be written waits until it can, and that is said meanwhile") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("not yet/alarms.sqlite");
  AlarmJournal journal(path);
  CHECK_FALSE(journal.problem().empty());
  CHECK(journal.before("shell").empty());
  journal.push(entry(1));
  ::mkdir(folder.file("not yet").c_str(), 0700);
  for (int i = 0; i < 100 && !journal.problem().empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK(journal.problem().empty());
  journal.push(entry(2));
  for (int i = 0; i < 100 && entries(path) < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(entries(path) == 2);
}

TEST_CASE("a damaged file is put aside, and a new one begun, whenever the damage is found") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alarms.sqlite");
  const bool at_start = GENERATE(true, false);
  {
    AlarmJournal journal(path);
    for (int i = 0; i < 1000; ++i) journal.push(entry(i));
  }
  std::string bytes = test::read_file(path);
  // All of it, or all but what opening looks at.
  const std::size_t from = at_start ? 0 : 3 * 4096;
  REQUIRE(bytes.size() > from);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end(), 'x');
  test::write_file(path, bytes);
  {
    AlarmJournal journal(path);
    CHECK(journal.before("shell").empty());
    journal.push(entry(1));
    for (int i = 0; i < 100 && journal.put_aside().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(journal.put_aside().find("the journal of alarms is damaged (") == 0);
    CHECK(journal.problem().empty());
  }
  CHECK(entries(path) == 1);
  int kept = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.file("")))
    kept += file.path().filename().string().starts_with("alarms.sqlite.damaged-") &&
            test::read_file(file.path()) == bytes;
  CHECK(kept == 1);
}

TEST_CASE("a journal that is removed while it is written is begun anew, and that is said") {
  const test::TemporaryFolder folder;
  const bool with_folder = GENERATE(true, false);
  const std::string state = folder.file("state");
  const std::string path = state + "/alarms.sqlite";
  std::filesystem::create_directory(state);
  AlarmJournal journal(path);
  journal.push(entry(1));
  for (int i = 0; i < 500 && entries(path) < 1; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  REQUIRE(entries(path) == 1);
  std::filesystem::remove_all(with_folder ? state : path);
  journal.push(entry(2));
  if (with_folder) {  // as long as it is away, it is said; what comes waits
    for (int i = 0; i < 500 && journal.problem().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK_THAT(journal.problem(), Catch::Matchers::Contains(path));
    std::filesystem::create_directory(state);
  }
  for (int i = 0; i < 500 && journal.before("shell").empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK_THAT(journal.put_aside(), Catch::Matchers::Contains("was removed while it was written"));
  REQUIRE(journal.before("shell").size() == 1);
  CHECK(journal.before("shell")[0].what == "2");
  CHECK(entries(path) == 1);
}

TEST_CASE("what waits for a disk that stays away does not fill the memory") {
  const test::TemporaryFolder folder;
  AlarmJournal journal(folder.file("never/alarms.sqlite"));
  for (int i = 0; i < 10'007; ++i) journal.push(entry(i));
  CHECK_THAT(journal.problem(), Catch::Matchers::Contains("entries are lost"));
}

}  // namespace
}  // namespace mpm::live
