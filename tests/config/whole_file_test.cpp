#include "config/whole_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <string>

#include "tests/system/process.hpp"

namespace mpm::config {
namespace {

std::string why_not(const std::string& path) {
  std::string why;
  CHECK_FALSE(read_whole_file(path, why));
  return why;
}

}  // namespace

TEST_CASE("a file is read whole") {
  const test::TemporaryFolder folder;
  std::string why, bytes(200'000, 'x');
  bytes[70'000] = '\0';
  test::write_file(folder.file("large"), bytes);
  test::write_file(folder.file("empty"), "");
  CHECK(read_whole_file(folder.file("large"), why) == bytes);
  CHECK(read_whole_file(folder.file("empty"), why) == "");
  CHECK(why.empty());
}

TEST_CASE("why a file cannot be read is told, and a pipe is not waited for") {
  const test::TemporaryFolder folder;
  CHECK(why_not(folder.file("none")) == "No such file or directory");
  CHECK(why_not(folder.file("")) == "Is a directory");
  REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK(why_not(folder.file("pipe")) == "no regular file");
  // A regular file whose first byte is no memory of this process.
  CHECK(why_not("/proc/self/mem") == "Input/output error");
}

}  // namespace mpm::config
