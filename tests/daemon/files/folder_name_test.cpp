#include "daemon/files/folder_name.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace mpm::files {

TEST_CASE("folders are named by a time and by what comes from outside, whatever it is called") {
  CHECK(time_folder(0) == "19700101T000000Z");
  CHECK(time_folder(1'714'564'800'250'000'000) == "20240501T120000.250Z");
  CHECK(time_folder(-1'000'000) == "19691231T235959.999Z");
  CHECK(folder_name("shell-3_x.y") == "shell-3_x.y");
  CHECK(folder_name("../a b") == "%2E.%2Fa%20b");
  CHECK(folder_name("..") == "%2E.");
}

// 255 bytes are what ext4, XFS and others take; "-000001.jsonl" and a second's part come behind.
TEST_CASE("the longest name of a unit fits a file system, and stays another than its neighbour's") {
  std::string name;
  for (int i = 0; i < 64; ++i) name += "\xC3\xA9";
  std::string other = name;
  other.back() = '\xA8';
  CHECK(folder_name(name).size() == 200);
  CHECK(folder_name(name) == folder_name(std::string(name)));
  CHECK(folder_name(name) != folder_name(other));
  CHECK(folder_name(name).substr(0, 12) == "%C3%A9%C3%A9");
}

}  // namespace mpm::files
