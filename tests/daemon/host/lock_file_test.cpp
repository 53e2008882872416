#include "daemon/host/lock_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <optional>
#include <stdexcept>

#include "tests/system/process.hpp"

namespace mpm::host {
namespace {

using Catch::Matchers::Contains;

std::string refusal(const std::string& path) {
  try {
    const LockFile second(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("of two the second one is refused, and told who holds the file") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file(".lock");
  std::optional<LockFile> first(path);
  CHECK(first->problem().empty());
  CHECK_THAT(refusal(path),
             Contains(path + ": is held by process " + std::to_string(getpid()) + " on host "));
  first.reset();
  CHECK(refusal(path).empty());
}

TEST_CASE("a lock is nobody else's to read, and no program's that is started") {
  const test::TemporaryFolder folder;
  const LockFile lock(folder.file(".lock"));
  struct stat status {};
  REQUIRE(stat(folder.file(".lock").c_str(), &status) == 0);
  CHECK((status.st_mode & (S_IRWXO | S_IWGRP)) == 0);
  bool kept = false;
  for (int descriptor = 3; descriptor < 100; ++descriptor) {
    struct stat other {};
    if (fstat(descriptor, &other) == 0 && other.st_ino == status.st_ino)
      kept = kept || (fcntl(descriptor, F_GETFD) & FD_CLOEXEC) == 0;
  }
  CHECK_FALSE(kept);
}

TEST_CASE("what cannot be locked is told, and no link is followed") {
  const test::TemporaryFolder folder;
  CHECK_THAT(LockFile("/proc/none/.lock").problem(),
             Contains("/proc/none/.lock: No such file or directory"));
  test::write_file(folder.file("precious"), "kept");
  REQUIRE(symlink(folder.file("precious").c_str(), folder.file(".lock").c_str()) == 0);
  CHECK_FALSE(LockFile(folder.file(".lock")).problem().empty());
  CHECK(test::read_file(folder.file("precious")) == "kept");
}

}  // namespace
}  // namespace mpm::host
