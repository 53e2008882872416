#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "daemon/bus/unit_inputs.hpp"
#include "tests/system/corner.hpp"

namespace mpm::test {
namespace {

TEST_CASE("mpm topics lists who is on the bus, with types and units") {
  const Corner corner("topics");
  Process topics = corner.start({"mpm", "topics", "--json", "--duration", "1"});
  CHECK(corner.publish_during(topics) == 0);
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : nlohmann::json::parse(read_file(corner.folder.file("started.out"))))
    rows[row["topic"]] = row;
  REQUIRE(rows.size() == 3);
  CHECK(rows["mpm/mv"] == nlohmann::json({{"topic", "mpm/mv"},
                                          {"type", "mpm::Sample"},
                                          {"writers", 1},
                                          {"readers", 0},
                                          {"units", {"toy"}}}));
  CHECK(rows["mpm/layout"]["type"] == "mpm::Layout");
  CHECK(corner.mpm({"topics", "--duration", "0.3"}) == 0);
  CHECK(corner.out() == "nobody else is on " + bus::place_text(corner.domain) + "\n");
}

TEST_CASE("mpm echo prints samples and ends when it has enough") {
  const Corner corner("echo");
  Process echo = corner.start({"mpm", "echo", "mpm/mv", "--unit", "toy", "--count", "3", "--json"});
  CHECK(corner.publish_during(echo) == 0);
  const auto lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(lines.size() == 3);
  const auto first = nlohmann::json::parse(lines[0]), last = nlohmann::json::parse(lines[2]);
  CHECK(first["sample"]["unit"] == "toy");
  CHECK(first["sample"]["values"].size() == 2);
  CHECK(last["sample"]["interval"] == first["sample"]["interval"].get<int>() + 2);
  CHECK(corner.mpm({"echo", "mpm/mv", "--once", "--unit", "toy", "--duration", "0.2"}) == 2);
  CHECK(corner.err() == "mpm echo: no sample of mpm/mv of unit toy came on " +
                            bus::place_text(corner.domain) + "\n");
  CHECK(corner.mpm({"echo", "mpm/nothing"}) == 3);
  CHECK(lines_of(corner.err()).size() == 1);
}

TEST_CASE("commands say that CYCLONEDDS_URI is set and not used") {
  const Corner corner("environment");
  const std::vector<std::string> uri = {"CYCLONEDDS_URI=file:///none"};
  const std::string out = corner.folder.file("out"), err = corner.folder.file("err");
  Process echo(corner.on_bus({"mpm", "echo", "mpm/mv", "--once", "--duration", "0.2"}), out, err,
               uri);
  CHECK(echo.wait(kPatience) == 2);
  CHECK(corner.err().find("mpm: CYCLONEDDS_URI is set, but not used; --dds-from-environment") == 0);
  Process status(corner.on_bus({"mpm", "status", "--wait", "0.2"}), out, err, uri);
  CHECK(status.wait(kPatience) == 2);
  CHECK(corner.out().find("(CYCLONEDDS_URI is set, but not used)") != std::string::npos);
}

TEST_CASE("mpm hz and delay measure a topic, also one that is not ours") {
  const Corner corner("hz");
  Process hz = corner.start({"mpm", "hz", "mpm/cv", "--json", "--duration", "1.5"});
  CHECK(corner.publish_during(hz) == 0);
  auto lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(!lines.empty());
  const auto rate = nlohmann::json::parse(lines.back());
  CHECK(rate["rate"].get<double>() > 20.0);  // 50, if the machine is not busy
  CHECK(rate["rate"].get<double>() < 60.0);
  CHECK(rate["window"].get<int>() > 20);
  Process delay = corner.start({"mpm", "delay", "mpm/cv", "--json", "--duration", "1"});
  CHECK(corner.publish_during(delay) == 0);
  lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(!lines.empty());
  CHECK(nlohmann::json::parse(lines.back())["min"].get<double>() > 0.0);
  CHECK(nlohmann::json::parse(lines.back())["min"].get<double>() < 0.1);

  const idl::Writer<mpm_Health> foreign(corner.participant, "site/health", idl::health_qos());
  Process other = corner.start({"mpm", "hz", "site/health", "--duration", "1.5", "--json"});
  mpm_Health health{};
  char unit[] = "far";
  health.unit = unit;
  std::optional<int> code;
  while (!code) {
    REQUIRE(foreign.write(health));
    code = other.wait(std::chrono::milliseconds(20));
  }
  CHECK(code == 0);
  CHECK(corner.mpm({"hz", "mpm/cv", "--duration", "0.3"}) == 2);
  CHECK(corner.mpm({"hz", "--peer", "127.0.0.1", "mpm/cv", "--duration", "0.3s"}) == 2);
  CHECK(corner.mpm({"hz", "mpm/cv", "--duration", "nan"}) == 3);
  CHECK(corner.mpm({"hz", "mpm/nothing"}) == 3);
}

TEST_CASE("mpm hz and delay end in peace when the reader of their pipe has left") {
  const Corner corner("left");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const char* command : {"hz", "delay"}) {
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(reader >= 0);
    Process process(corner.on_bus({"mpm", command, "mpm/cv"}), pipe, corner.folder.file("err"));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(process.pid()); }, kPatience));
    close(reader);
    CHECK(corner.publish_during(process) == 0);
    CHECK(corner.err().empty());
  }
}

TEST_CASE("mpm echo and watch end when the reader of their pipe has left, though nothing comes") {
  const Corner corner("silent-left");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const auto& arguments : {std::vector<std::string>{"mpm", "echo", "mpm/alarm"},
                                std::vector<std::string>{"mpm", "watch", "--json"}}) {
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(reader >= 0);
    Process process(corner.on_bus(arguments), pipe, corner.folder.file("err"));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(process.pid()); }, kPatience));
    close(reader);
    CHECK(process.wait(kPatience) == 0);
    CHECK(corner.err().empty());
  }
}

}  // namespace
}  // namespace mpm::test
