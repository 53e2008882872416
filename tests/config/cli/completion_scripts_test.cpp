#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::completion_scripts_test {
namespace {

int in(const Bench& bench, const std::vector<std::string>& arguments) {
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

// In a bash that knows the completion, `line` as it stands when Tab is pressed.
std::string completed(const Bench& bench, const std::string& words) {
  const std::string script = "source " + bench.folder.file("mpm.bash") + "; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _mpm; echo "
                             "\"${COMPREPLY[*]}\"";
  write_file(bench.folder.file("tab.sh"), script);
  REQUIRE(in(bench, {"/bin/bash", bench.folder.file("tab.sh")}) == 0);
  CHECK(bench.text("err").empty());
  return bench.text("out");
}

}  // namespace

TEST_CASE("bash completes commands, options and values") {
  Bench bench;
  REQUIRE(in(bench, {"mpm", "completion", "bash"}) == 0);
  write_file(bench.folder.file("mpm.bash"), bench.text("out"));
  REQUIRE(in(bench, {"/bin/bash", "-n", bench.folder.file("mpm.bash")}) == 0);
  CHECK(bench.text("err").empty());
  CHECK(completed(bench, "mpm det") == "detect\n");
  CHECK(completed(bench, "mpm detect --conf") == "--config\n");
  CHECK(completed(bench, "mpm detect --config ''") == "\n");  // then bash offers files
  CHECK(completed(bench, "mpm publish --format c") == "csv\n");
  CHECK(completed(bench, "mpm completion z") == "zsh\n");
  CHECK(in(bench, {"mpm", "completion", "tcsh"}) == 3);
}

TEST_CASE("the other shells' scripts tell every command") {
  Bench bench;
  REQUIRE(in(bench, {"mpm", "completion", "zsh"}) == 0);
  const std::string zsh = bench.text("out");
  CHECK(zsh.rfind("#compdef mpm\n", 0) == 0);
  CHECK(zsh.find("'(--format)--format[of the lines; auto looks at the first "
                 "one]:value:(auto json csv)'") != std::string::npos);
  REQUIRE(in(bench, {"mpm", "completion", "fish"}) == 0);
  const std::string fish = bench.text("out");
  CHECK(fish.find("complete -c mpm -n '__fish_seen_subcommand_from publish' -l format -x -a "
                  "'auto json csv'") != std::string::npos);
  for (const std::string command : {"detect", "diagnose", "watch", "delay", "man"}) {
    CHECK(zsh.find("    '" + command + ":") != std::string::npos);
    CHECK(fish.find(" -n __fish_use_subcommand -a " + command + " -d ") != std::string::npos);
  }
}

}  // namespace mpm::test::completion_scripts_test
