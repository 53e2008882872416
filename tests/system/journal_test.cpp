#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::journal_test {
namespace {

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

constexpr int kDigests = 10;  // of 60 samples each

int digests(const std::string& journal) {
  const std::vector<std::string> lines = lines_of(journal);
  return static_cast<int>(std::count_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find(R"("record":"digest")") != std::string::npos;
  }));
}

// Killed while it writes as fast as it can: all lines but a last one are whole, and the next daemon
// goes on in a file of its own.
TEST_CASE("a journal whose daemon was killed is read, and goes on") {
  TemporaryFolder folder;
  const idl::DomainOptions domain = idl::test_domain("killed_journal");
  const std::string journal = folder.file("journal");
  for (int life = 1; life <= 2; ++life) {
    Process daemon(
        {"mpmd", "--config", kUnit, "--partition", domain.partition, "--journal", journal},
        folder.file("mpmd.out"), folder.file("mpmd.err"));
    Process plant({"mpmsim", "--config", kUnit, "--scenario", "hidden_gain", "--seed", "5",
                   "--samples", "1000000", "--start-time", life == 1 ? "0" : "86400", "--speed",
                   "0", "--wait-readers", "20", "--partition", domain.partition},
                  folder.file("sim.out"), folder.file("sim.err"));
    const std::string path = journal + "/shell-00000" + std::to_string(life) + ".jsonl";
    CHECK(idl::eventually([&] { return digests(read_file(path)) >= kDigests; },
                          std::chrono::seconds(60)));
    daemon.send(SIGKILL);
    CHECK(daemon.wait(std::chrono::seconds(5)) == 128 + SIGKILL);
    plant.send(SIGKILL);
    const std::string text = read_file(path);
    std::size_t line = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos;
         line = end + 1, end = text.find('\n', line))
      CHECK(nlohmann::json::accept(text.substr(line, end - line)));
  }
  REQUIRE(run({"mpm", "trend", "--journal", journal, "--json"}, folder.file("out"),
              folder.file("err")) == 0);
  const auto trend = nlohmann::json::parse(read_file(folder.file("out")));
  CHECK(trend["samples"] >= 2 * kDigests * 60);
  CHECK(trend["periods"].back()["from"] >= 86400.0);
}

TEST_CASE("a journal where none can be is told at the start, and the monitor watches on") {
  TemporaryFolder folder;
  const std::string place = "/no/such/folder/x";
  Process daemon({"mpmd", "--config", kUnit, "--partition",
                  idl::test_domain("no_journal").partition, "--journal", place},
                 folder.file("out"), folder.file("err"));
  CHECK(idl::eventually([&] {
    return read_file(folder.file("err"))
               .find("the journal cannot be written: " + place + ": No such file or directory") !=
           std::string::npos;
  }));
  daemon.send(SIGTERM);
  CHECK(daemon.wait(std::chrono::seconds(10)) == 0);
  CHECK(run({"mpmd", "--config", kUnit, "--journal", folder.file("j"), "--journal-keep", "10kB"},
            folder.file("out"), folder.file("err")) == 3);
  CHECK(run({"mpmd", "--config", kUnit, "--journal-every-sample", place}, folder.file("out"),
            folder.file("err")) == 2);
  CHECK(read_file(folder.file("err")).find(" error mpmd: error: " + place) != std::string::npos);
}

}  // namespace
}  // namespace mpm::test::journal_test
