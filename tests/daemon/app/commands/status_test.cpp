#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::test {

// The codes of the Monitoring Plugins guidelines: 2 critical, 3 unknown.
TEST_CASE("mpm status says one line, whatever happens") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  CHECK(
      run({"mpm", "status", "--domain", "7", "--partition", "status-test-nobody", "--wait", "0.3"},
          out, err) == 2);
  CHECK(read_file(out) == "MPM CRITICAL: no monitor on domain 7, partition 'status-test-nobody'\n");
  CHECK(run({"mpm", "status", "--config", folder.file("none.yaml")}, out, err) == 3);
  CHECK(read_file(out).find("MPM UNKNOWN: ") == 0);
  CHECK(run({"mpm", "status", "--interface", "nosuchnic0"}, out, err) == 3);
  CHECK(lines_of(read_file(out)).size() == 1);
  CHECK(read_file(err).empty());
}

}  // namespace mpm::test
