#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::man_page_test {
namespace {

int in(const Bench& bench, const std::vector<std::string>& arguments) {
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

}  // namespace

TEST_CASE("the manual page has every command, and nothing in it is taken for a request") {
  Bench bench;
  REQUIRE(in(bench, {"mpm", "man"}) == 0);
  const std::vector<std::string> lines = lines_of(bench.text("out"));
  REQUIRE(!lines.empty());
  CHECK(lines.front().rfind(".TH MPM 1 ", 0) == 0);
  for (const char* heading : {".SH NAME", ".SH SYNOPSIS", ".SH COMMANDS", ".SS detect", ".SS man"})
    CHECK(std::count(lines.begin(), lines.end(), heading) == 1);
  for (const std::string& line : lines) {
    if (line.empty() || line[0] != '.') continue;
    const std::string request = line.substr(0, line.find(' '));
    CAPTURE(line);
    CHECK((request == ".TH" || request == ".SH" || request == ".SS" || request == ".TP" ||
           request == ".PP" || request == ".nf" || request == ".fi" || request == ".B"));
  }
}

}  // namespace mpm::test::man_page_test
