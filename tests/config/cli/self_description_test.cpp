#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::self_description_test {
namespace {

int in(const Bench& bench, const std::vector<std::string>& arguments) {
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

}  // namespace

TEST_CASE("programs without commands print their own manual page and completions") {
  Bench bench;
  const std::string program = GENERATE("mpmd", "mpmsim");
  CAPTURE(program);
  REQUIRE(in(bench, {program, "--man"}) == 0);
  CHECK(bench.text("err").empty());
  CHECK(bench.text("out").rfind(program == "mpmd" ? ".TH MPMD 1 " : ".TH MPMSIM 1 ", 0) == 0);
  CHECK(bench.text("out").find("\\fB\\-\\-config") != std::string::npos);
  CHECK(bench.text("out").find(".SH COMMANDS") == std::string::npos);
  REQUIRE(in(bench, {program, "--completion", "zsh"}) == 0);
  CHECK(bench.text("out").rfind("#compdef " + program + "\n", 0) == 0);
  REQUIRE(in(bench, {program, "--completion", "fish"}) == 0);
  CHECK(bench.text("out").find("complete -c " + program + " -s c -l config -r -F") !=
        std::string::npos);
  CHECK(in(bench, {program, "--completion", "tcsh"}) == 3);
}

TEST_CASE("bash completes the options and values of a program without commands") {
  Bench bench;
  REQUIRE(in(bench, {"mpmd", "--completion", "bash"}) == 0);
  write_file(bench.folder.file("mpmd.bash"), bench.text("out"));
  const auto completed = [&](const std::string& words) {
    write_file(bench.folder.file("tab.sh"),
               "source " + bench.folder.file("mpmd.bash") + "; COMP_WORDS=(" + words +
                   "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _mpmd; echo \"${COMPREPLY[*]}\"");
    REQUIRE(in(bench, {"/bin/bash", bench.folder.file("tab.sh")}) == 0);
    CHECK(bench.text("err").empty());
    return bench.text("out");
  };
  CHECK(completed("mpmd --jou") == "--journal --journal-keep --journal-every-sample\n");
  CHECK(completed("mpmd --config a.yaml --log-level w") == "warning\n");
}

}  // namespace mpm::test::self_description_test
