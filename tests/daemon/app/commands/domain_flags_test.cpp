#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::domain_flags_test {
namespace {

int in(const Bench& bench, const std::vector<std::string>& arguments) {
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

}  // namespace

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

}  // namespace mpm::test::domain_flags_test
