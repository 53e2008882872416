#include "daemon/files/folder_name.hpp"

#include <catch2/catch.hpp>

namespace mpm::files {

TEST_CASE("folders are named by a time and by what comes from outside, whatever it is called") {
  CHECK(time_folder(0) == "19700101T000000Z");
  CHECK(time_folder(1'714'564'800'250'000'000) == "20240501T120000.250Z");
  CHECK(time_folder(-1'000'000) == "19691231T235959.999Z");
  CHECK(folder_name("shell-3_x.y") == "shell-3_x.y");
  CHECK(folder_name("../a b") == "%2E.%2Fa%20b");
  CHECK(folder_name("..") == "%2E.");
}

}  // namespace mpm::files
