#include "config/replacement_file.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "config/finding.hpp"
#include "tests/system/process.hpp"

namespace replacement_file_test {

using mpm::config::ReplacementFile;
using mpm::test::read_file;
using mpm::test::TemporaryFolder;
using mpm::test::write_file;

namespace {

/// What somebody else lays beside `name`: every name that can be foreseen leads to `victim`.
void plant_links(const TemporaryFolder& folder, const std::string& name,
                 const std::string& victim) {
  const std::string pid = std::to_string(getpid());
  for (const std::string& foreseen :
       {"." + name + "." + pid, name + "." + pid, "." + name + ".tmp", name + ".tmp", name + "~"})
    std::filesystem::create_symlink(victim, folder.file(foreseen));
}

std::size_t entries_of(const std::string& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a file that replaces another is written to nothing that others made") {
  TemporaryFolder folder;
  const std::string victim = folder.file("victim");
  write_file(victim, "precious");
  plant_links(folder, "out.csv", victim);
  {
    ReplacementFile file(folder.file("out.csv"));
    write_file(folder.file("out.csv"), "old");
    file.write("new");
    CHECK(read_file(folder.file("out.csv")) == "old");
    file.commit();
  }
  CHECK(read_file(folder.file("out.csv")) == "new");
  CHECK(read_file(victim) == "precious");
}

TEST_CASE("what somebody puts in the temporary file's place is not written to") {
  TemporaryFolder folder;
  const std::string victim = folder.file("victim");
  write_file(victim, "precious");
  ReplacementFile file(folder.file("out.csv"));
  std::filesystem::remove(file.temporary());
  std::filesystem::create_symlink(victim, file.temporary());
  file.write("new");
  file.stream() << "er";
  CHECK(file.bytes() == 5);
  CHECK(read_file(victim) == "precious");
}

TEST_CASE("what is not committed leaves nothing behind") {
  TemporaryFolder folder;
  {
    ReplacementFile file(folder.file("out.csv"));
    ReplacementFile other(folder.file("out.csv"));
    CHECK(file.temporary() != other.temporary());
    file.write("half");
    CHECK(entries_of(folder.file(".")) == 0);  // neither has a name
  }
  CHECK(entries_of(folder.file(".")) == 0);
  CHECK_THROWS_AS(ReplacementFile(folder.file("nowhere/out.csv")), mpm::config::InputError);
  CHECK_THROWS_AS(ReplacementFile(folder.file(".")), mpm::config::InputError);
}

// Debian's usual file systems (ext4, xfs, btrfs, tmpfs) have files without a name.
TEST_CASE("a process that is killed while it writes leaves nothing behind") {
  TemporaryFolder folder;
  write_file(folder.file("out.csv"), "old");
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ReplacementFile file(folder.file("out.csv"));
    file.write("half");
    raise(SIGKILL);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFSIGNALED(status));
  CHECK(entries_of(folder.file(".")) == 1);
  CHECK(read_file(folder.file("out.csv")) == "old");
}

TEST_CASE("what is read is not replaced, by whatever name") {
  TemporaryFolder folder;
  write_file(folder.file("unit.yaml"), "precious");
  std::filesystem::create_symlink("unit.yaml", folder.file("link"));
  using mpm::config::refuse_to_replace;
  const std::vector<std::string> inputs = {"", "data.csv", folder.file("unit.yaml")};
  for (const char* name : {"unit.yaml", "./unit.yaml", "link"})
    CHECK_THROWS_WITH(refuse_to_replace(inputs, folder.file(name)),
                      folder.file(name) + ": error: is the file that is read");
  CHECK_NOTHROW(refuse_to_replace(inputs, folder.file("new.yaml")));
  CHECK_NOTHROW(refuse_to_replace(inputs, ""));
}

TEST_CASE("two outputs that would be one file are refused, by whatever names") {
  using mpm::config::refuse_one_place;
  TemporaryFolder folder;
  const std::string out = folder.file("out");
  CHECK_THROWS_WITH(refuse_one_place(out, out), out + ": error: is given for two outputs");
  CHECK_THROWS(refuse_one_place(out, folder.file(".") + "/out"));
  write_file(out, "");
  std::filesystem::create_symlink(out, folder.file("link"));
  CHECK_THROWS(refuse_one_place(out, folder.file("link")));
  CHECK_NOTHROW(refuse_one_place(out, folder.file("other")));
  CHECK_NOTHROW(refuse_one_place("", ""));
  CHECK_NOTHROW(refuse_one_place("/dev/null", "/dev/null"));
}

TEST_CASE("a pipe, a device or a link is not replaced by a file") {
  namespace fs = std::filesystem;
  TemporaryFolder folder;
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  fs::create_symlink("/dev/null", folder.file("device"));
  fs::create_symlink("nowhere", folder.file("broken"));
  write_file(folder.file("file"), "precious");
  fs::create_symlink("file", folder.file("link"));
  for (const char* name : {"pipe", "device", "broken", "link"}) {
    const std::string path = folder.file(name);
    const fs::file_type before = fs::symlink_status(path).type();
    CHECK_THROWS_WITH(ReplacementFile(path), Catch::Contains("which a file would replace"));
    CHECK(fs::symlink_status(path).type() == before);
  }
  CHECK(entries_of(folder.file(".")) == 5);
}

}  // namespace replacement_file_test
