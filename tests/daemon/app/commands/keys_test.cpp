#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/system/process.hpp"

namespace mpm::test {

TEST_CASE("mpm keys makes keys once, and says how to make the next ones") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err"), keys = folder.file("keys");
  CHECK(run({"mpm", "keys", "--out", keys, "--days", "30"}, out, err) == 0);
  const std::string said = read_file(out);
  CHECK(said.starts_with(keys + ": monitor gateway operator viewer\nvalid until 20"));
  CHECK(said.find("mpm keys --out NEW --authority " + keys + "/ca\n") != std::string::npos);
  CHECK(run({"mpm", "keys", "--out", keys}, out, err) == 3);
  CHECK(read_file(err) == "mpm: error: " + keys + " is there; keys are never overwritten\n");
  CHECK(run({"mpm", "keys", "--out", folder.file("next"), "--authority", keys + "/ca"}, out, err) ==
        0);
  CHECK(std::filesystem::exists(folder.file("next") + "/viewer/key.pem"));
  CHECK(run({"mpm", "keys", "--out", folder.file("none"), "--authority", folder.file("none")}, out,
            err) == 2);
  CHECK(run({"mpm", "keys", "--out", folder.file("none"), "--days", "0"}, out, err) == 3);
  CHECK_FALSE(std::filesystem::exists(folder.file("none")));
  // No secret leaves its file.
  CHECK(said.find("PRIVATE") == std::string::npos);
}

}  // namespace mpm::test
