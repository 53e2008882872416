#include <sys/resource.h>

#include <catch2/catch.hpp>

#include "tests/allocation_counter.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("an input without an end of line is refused before it fills the memory") {
  TemporaryFolder folder;
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_DATA, &before) == 0);
  // The line was kept before: 4 GB and more.
  const rlimit small{resident_memory_is_ours() ? 500'000'000 : before.rlim_cur, before.rlim_max};
  REQUIRE(setrlimit(RLIMIT_DATA, &small) == 0);
  const auto code =
      run({"mpm", "publish", "--config", MPM_SOURCE_DIR "/config/plants/shell3x3.yaml"},
          folder.file("out"), folder.file("err"), "/dev/zero");
  REQUIRE(setrlimit(RLIMIT_DATA, &before) == 0);
  CHECK(code == 3);
  CHECK(read_file(folder.file("err")) == "stdin:1:1: error: a line of more than 4 MiB\n");
}

}  // namespace mpm::test
