#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("what is missing in one of several data files is told with its name") {
  const TemporaryFolder folder;
  write_file(folder.file("unit.yaml"), "unit: u\nsample_time: 1\nsignals: {mv: [u], cv: [y]}\n");
  std::string whole = "time,u,y\n", holed = whole;
  for (int k = 0; k < 100; ++k) {
    const std::string row = std::to_string(k) + "," + std::to_string(k / 7 % 2) + ",1\n";
    whole += row;
    if (k != 50) holed += row;
  }
  write_file(folder.file("whole.csv"), whole);
  write_file(folder.file("holed.csv"), holed);
  CHECK(run({"mpm", "identify", "--config", folder.file("unit.yaml"), "--data",
             folder.file("whole.csv"), folder.file("holed.csv"), "--out", folder.file("new.yaml")},
            folder.file("out"), folder.file("err")) == 1);  // y stands still
  const std::string notices = read_file(folder.file("err"));
  CHECK(notices.find("holed.csv: 1 interval without a row") != std::string::npos);
  CHECK(notices.find("whole.csv: 1") == std::string::npos);
}

}  // namespace mpm::test
