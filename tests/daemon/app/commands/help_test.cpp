#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
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

TEST_CASE("a unit file tells where its bus is, and options overrule it") {
  Bench bench;
  for (const char* command : {"watch", "topics", "echo", "hz", "delay", "record", "replay"}) {
    CAPTURE(command);
    CHECK(in(bench, {"mpm", command, "--help"}) == 0);
    CHECK(bench.text("out").find("-c,--config") != std::string::npos);
  }
  CHECK(in(bench, {"mpm", "topics", "--config", bench.folder.file("none.yaml")}) == 3);
  CHECK(bench.text("err").find("none.yaml") != std::string::npos);

  // A network interface that no machine has cannot be opened, unless an option says otherwise.
  const std::string file = bench.folder.file("small.yaml");
  write_file(file, kSmall + "dds: {interface: nowhere0}\n");
  const std::vector<std::string> look = {"mpm", "topics", "--duration", "0.1"};
  const auto with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = look;
    arguments.insert(arguments.end(), options.begin(), options.end());
    return in(bench, arguments);
  };
  CHECK(with({"--config", file}) == 2);
  CHECK(bench.text("err").find("nowhere0") != std::string::npos);
  CHECK(with({"--config", file, "--interface", "lo"}) == 0);
  CHECK(with({"--interface", "lo", "--config", file}) == 0);
}

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

}  // namespace mpm::test
