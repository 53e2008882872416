#include "daemon/history/journal_files.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <system_error>

#include "tests/daemon/history/full_disk.hpp"
#include "tests/system/process.hpp"

namespace mpm::history {
namespace {

std::size_t bytes_in(const std::string& folder) {
  std::size_t sum = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) sum += entry.file_size();
  return sum;
}

TEST_CASE("journal files are numbered on, and the oldest go") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("journal");
  constexpr std::uint64_t kKeep = 16'000;  // files of 1000 bytes
  const std::string line(99, 'x');
  {
    JournalFiles files(place, "shell", kKeep);
    CHECK(files.empty());
    for (int i = 0; i < 1000; ++i) {
      files.turn_over();
      REQUIRE(files.append(line + "\n"));
      REQUIRE(bytes_in(place) <= kKeep);
    }
  }
  CHECK_FALSE(std::filesystem::exists(place + "/shell-000001.jsonl"));
  CHECK(std::filesystem::exists(place + "/shell-000100.jsonl"));
  CHECK(bytes_in(place) > kKeep / 2);
  test::write_file(place + "/other-000001.jsonl", std::string(50'000, 'x'));  // not ours: stays
  test::write_file(place + "/shell-000101.jsonl", "");  // of a start without a sample
  JournalFiles next(place, "shell", kKeep);
  CHECK(next.empty());
  REQUIRE(next.append("new\n"));
  CHECK(test::read_file(place + "/shell-000101.jsonl") == "new\n");
  CHECK(std::filesystem::exists(place + "/other-000001.jsonl"));
}

TEST_CASE("a full disk costs what it does not take, and no half a line stays") {
  const test::TemporaryFolder folder;
  JournalFiles files(folder.file("journal"), "shell", 1'000'000);
  const std::string path = folder.file("journal") + "/shell-000001.jsonl";
  REQUIRE(files.append("one\n"));
  {
    const test::FullDisk full(10);
    CHECK_FALSE(files.append("two, which is too long\n"));
    CHECK(files.problem() == "File too large");
    CHECK(test::read_file(path) == "one\n");
  }
  CHECK(files.append("three\n"));
  CHECK(files.problem().empty());
  CHECK(test::read_file(path) == "one\nthree\n");
}

TEST_CASE("a journal whose folder is removed begins a new one, or says why it cannot") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("journal");
  JournalFiles files(place, "shell", 1'000'000);
  REQUIRE(files.append("one\n"));
  std::filesystem::remove_all(place);
  CHECK_FALSE(files.append("lost\n"));
  CHECK(files.problem() == "No such file or directory");
  files.turn_over();
  CHECK(files.empty());
  CHECK(files.append("two\n"));
  CHECK(files.problem().empty());
  CHECK(test::read_file(place + "/shell-000002.jsonl") == "two\n");

  std::filesystem::remove_all(place);
  test::write_file(place, "in the way");
  files.turn_over();
  CHECK(files.problem() == "Not a directory");
  CHECK_FALSE(files.append("lost\n"));
  std::filesystem::remove(place);
  files.turn_over();
  CHECK(files.append("three\n"));
  CHECK(test::read_file(place + "/shell-000003.jsonl") == "three\n");
}

TEST_CASE("a journal where none can be says so, and begins once it can") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("a/journal");
  JournalFiles files(place, "shell", 1000);
  CHECK(files.problem() == place + ": No such file or directory");
  CHECK_FALSE(files.append("lost\n"));
  CHECK(files.empty());
  std::filesystem::create_directory(folder.file("a"));
  files.turn_over();
  CHECK(files.problem().empty());
  CHECK(files.append("one\n"));
  CHECK(test::read_file(place + "/shell-000001.jsonl") == "one\n");

  test::write_file(folder.file("file"), "");
  CHECK(JournalFiles(folder.file("file"), "shell", 1000).problem() ==
        folder.file("file") + ": Not a directory");
}

TEST_CASE("names of journal files tell whose they are") {
  std::string unit;
  int number = 0;
  CHECK(parse_journal_name("a-b-000012.jsonl", unit, number));
  CHECK(unit == "a-b");
  CHECK(number == 12);
  for (const char* other : {"a-12.jsonl", "000012.jsonl", "a-000012.json", "a-00001x.jsonl",
                            "-000012.jsonl", "a-0000000012.jsonl"})
    CHECK_FALSE(parse_journal_name(other, unit, number));
}

}  // namespace
}  // namespace mpm::history
