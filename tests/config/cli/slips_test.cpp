#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::slips_test {
namespace {

int in(const Bench& bench, const std::vector<std::string>& arguments) {
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

}  // namespace

TEST_CASE("a slip in a command or an option is told with what was likely meant") {
  Bench bench;
  CHECK(in(bench, {"mpm", "detct", "--config", "x.yaml"}) == 3);
  CHECK(bench.text("err") ==
        "mpm: error: 'detct' is no command (did you mean 'detect'?)\n"
        "Run with --help for more information.\n");
  CHECK(in(bench, {"mpm", "detect", "--confg", "x.yaml", "--data", "y.csv"}) == 3);
  CHECK(bench.text("err") ==
        "mpm detect: error: '--confg' is no option (did you mean '--config'?)\n"
        "Run with --help for more information.\n");
  CHECK(in(bench, {"mpm", "--vrsion"}) == 3);
  CHECK(bench.text("err").find("'--vrsion' is no option (did you mean '--version'?)") !=
        std::string::npos);
  CHECK(in(bench, {"mpmd", "--confg", "x.yaml"}) == 3);
  CHECK(bench.text("err").find("mpmd: error: '--confg' is no option (did you mean '--config'?)") !=
        std::string::npos);
  CHECK(in(bench, {"mpm", "detect", "--data", "y.csv"}) == 3);  // no slip
  CHECK(bench.text("err").find("--config is required") != std::string::npos);
  CHECK(in(bench, {"mpm", "detct", "--help"}) == 0);
  CHECK(bench.text("out").find("Examples:\n  mpm detect ") != std::string::npos);
}

TEST_CASE("every program tells its version") {
  Bench bench;
  for (const std::string program : {"mpm", "mpmd", "mpmsim"}) {
    CHECK(in(bench, {program, "--version"}) == 0);
    CHECK(bench.text("out").rfind(program + " ", 0) == 0);
    CHECK(bench.text("out").find("Cyclone DDS ") != std::string::npos);
  }
}

}  // namespace mpm::test::slips_test
