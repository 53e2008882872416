#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("the help of every program fits a terminal of 80 columns") {
  const TemporaryFolder folder;
  const std::string program = GENERATE("mpm", "mpmd", "mpmsim");
  REQUIRE(run({program, "--help"}, folder.file("out"), folder.file("err")) == 0);
  const auto lines = lines_of(read_file(folder.file("out")));
  CHECK(lines.size() > 20);
  for (const std::string& line : lines) {
    INFO(line);
    CHECK(line.size() <= 80);
  }
}

}  // namespace mpm::test
