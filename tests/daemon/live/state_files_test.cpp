#include "daemon/live/state_files.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "config/replacement_file.hpp"
#include "daemon/live/numbered_files.hpp"
#include "tests/system/process.hpp"

namespace mpm::live::state_files_test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

Bytes some_bytes(std::uint64_t seed, std::size_t count = 5000) {
  std::mt19937_64 random(seed);
  Bytes bytes(count);
  for (std::byte& each : bytes) each = static_cast<std::byte>(random());
  return bytes;
}

std::string path(const test::TemporaryFolder& folder, std::uint64_t file) {
  return numbered_path(folder.file(""), "state-", file);
}

void begin(StateFiles& states, std::uint64_t file, const Bytes& bytes) {
  CHECK(states.keep([&](Bytes& to) {
    to = bytes;
    return std::optional(file);
  }));
}

/// Written by a thread; whoever leaves waits for it.
void keep(const std::string& folder, const std::string& belongs, std::uint64_t file,
          const Bytes& bytes) {
  StateFiles states(folder, belongs);
  begin(states, file, bytes);
}

void await(StateFiles& states) {
  while (!states.poll()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

std::optional<Bytes> read(const StateFiles& states, std::uint64_t file) {
  std::string why;
  return states.read(file, why);
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

TEST_CASE("the last two states are kept, and come back as they were") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  const std::vector<std::uint64_t> log = {7, 8, 9, 10, 11};
  CHECK(StateFiles(place, "a").find(log).empty());
  for (const std::uint64_t file : {8U, 9U, 10U}) keep(place, "a", file, some_bytes(file));
  StateFiles states(place, "a");
  CHECK(states.find(log) == std::vector<std::uint64_t>{10, 9});
  CHECK(states.oldest() == 9);
  CHECK(read(states, 10) == some_bytes(10));
  CHECK(read(states, 9) == some_bytes(9));
  CHECK_FALSE(read(states, 8));
  CHECK(names_in(place) == std::set<std::string>{"state-000000000009", "state-000000000010"});

  keep(place, "a", 11, {});
  REQUIRE(read(states, 11));
  CHECK(read(states, 11)->empty());
}

TEST_CASE("a state whose file of the log has gone goes too") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  for (const std::uint64_t file : {8U, 9U}) keep(place, "a", file, some_bytes(file));
  std::ofstream(folder.file("state-x")) << "somebody's";
  std::ofstream(folder.file("state-08")) << "somebody's";
  CHECK(StateFiles(place, "a").find({1, 2, 8}) == std::vector<std::uint64_t>{8});
  CHECK(names_in(place) == std::set<std::string>{"state-000000000008", "state-x", "state-08"});
}

TEST_CASE("what a killed process was writing does not stay for ever") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  keep(place, "a", 8, some_bytes(8));
  // As it is left where the file system has no files without a name.
  test::write_file(config::ReplacementFile(path(folder, 9)).temporary(), "half of it");
  CHECK(names_in(place).size() == 2);
  CHECK(StateFiles(place, "a").find({8, 9}) == std::vector<std::uint64_t>{8});
  CHECK(names_in(place) == std::set<std::string>{"state-000000000008"});
}

TEST_CASE("a state of another program or unit is not used") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  keep(place, "a", 8, some_bytes(8));
  CHECK_FALSE(read(StateFiles(place, "b"), 8));
  CHECK_FALSE(read(StateFiles(place, ""), 8));
  // Nor is one under another's number.
  fs::rename(path(folder, 8), path(folder, 9));
  CHECK_FALSE(read(StateFiles(place, "a"), 9));
}

TEST_CASE("why a state is not used is told") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  keep(place, "a", 8, some_bytes(8));
  std::string why;
  CHECK_FALSE(StateFiles(place, "a").read(9, why));
  CHECK(why == "it cannot be read: No such file or directory");
  CHECK_FALSE(StateFiles(place, "b").read(8, why));
  CHECK(why == StateFiles::kBelongsElsewhere);
  test::write_file(path(folder, 8), "mpm state 1\nhalf");
  CHECK_FALSE(StateFiles(place, "a").read(8, why));
  CHECK(why == "it is damaged");
  fs::create_directory(path(folder, 9));
  CHECK_FALSE(StateFiles(place, "a").read(9, why));
  CHECK(why == "it cannot be read: Is a directory");
}

// CRC-32 finds every burst of up to 32 bits.
TEST_CASE("a damaged state is not used") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  keep(place, "a", 8, some_bytes(8, 300));
  const std::string whole = test::read_file(path(folder, 8));
  StateFiles states(place, "a");
  std::mt19937 random(5);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] =
        static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ (1U << (random() % 8)));
    test::write_file(path(folder, 8), damaged);
    if (read(states, 8)) FAIL("byte " << at << " was damaged");
    test::write_file(path(folder, 8), whole.substr(0, at));
    if (read(states, 8)) FAIL("all from byte " << at << " on was lost");
  }
  test::write_file(path(folder, 8), std::string(whole.size(), '\0'));
  CHECK_FALSE(read(states, 8));
  test::write_file(path(folder, 8), whole);
  CHECK(read(states, 8));
}

TEST_CASE("what names no file is not written, and costs the one before nothing") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("");
  keep(place, "a", 8, some_bytes(8));
  StateFiles states(place, "a");
  states.expect(10'000);
  CHECK_FALSE(states.keep([](Bytes& to) {
    CHECK(to.capacity() >= 10'000);
    to = some_bytes(9);
    return std::optional<std::uint64_t>();
  }));
  CHECK(names_in(place) == std::set<std::string>{"state-000000000008"});
  begin(states, 10, {});  // nothing of 9 is left
  await(states);
  REQUIRE(read(states, 10));
  CHECK(read(states, 10)->empty());
}

TEST_CASE("what cannot be written is told, and the state before stays") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("states");
  fs::create_directory(place);
  keep(place, "a", 8, some_bytes(8));
  StateFiles states(place, "a");
  fs::rename(place, folder.file("away"));
  begin(states, 9, some_bytes(9));
  await(states);
  CHECK(states.problem().find(place) != std::string::npos);
  fs::rename(folder.file("away"), place);
  CHECK(read(states, 8) == some_bytes(8));
  begin(states, 10, some_bytes(10));
  await(states);
  CHECK(states.problem().empty());
  CHECK(states.oldest() == 8);
  begin(states, 11, some_bytes(11));
  await(states);
  CHECK(states.oldest() == 10);
  CHECK(read(states, 10) == some_bytes(10));
}

}  // namespace
}  // namespace mpm::live::state_files_test
