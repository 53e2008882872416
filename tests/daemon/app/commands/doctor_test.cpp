#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

std::string unit_yaml(const std::string& unit, int domain) {
  return "unit: " + unit +
         "\nsample_time: 1.0\nsignals: {mv: [{tag: u1}], cv: [{tag: y1}]}\n"
         "model: {channels: [{cv: y1, mv: u1, gain: 2, time_constants: [5]}]}\n"
         "dds: {domain: " +
         std::to_string(domain) + ", partition: doctor-test-nobody}\n";
}

}  // namespace

TEST_CASE("mpm doctor tells trouble from wrong use by its exit code") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  write_file(folder.file("one.yaml"), unit_yaml("one", 11));
  write_file(folder.file("other.yaml"), unit_yaml("other", 12));
  write_file(folder.file("bad.yaml"), unit_yaml("bad", 11) + "no_such_key: 1\n");

  CHECK(run({"mpm", "doctor", "--seconds", "no"}, out, err) == 3);
  CHECK(run({"mpm", "doctor", "--config", folder.file("none.yaml")}, out, err) == 3);
  CHECK(run({"mpm", "doctor", "--config", folder.file("bad.yaml")}, out, err) == 3);
  CHECK(read_file(err).find(folder.file("bad.yaml") + ":6:1: error: ") == 0);
  CHECK(run({"mpm", "doctor", "--interface", "nosuchnic0"}, out, err) == 2);
  CHECK(run({"mpm", "doctor", "--config", folder.file("one.yaml"), "--seconds", "0.3"}, out, err) ==
        1);
  const std::string text = read_file(out);
  INFO(text);
  // A domain that no other test uses: whoever else is on it would be told of.
  const std::string place = "domain 11, partition 'doctor-test-nobody'";
  CHECK(text.find("nobody else is on " + place) != std::string::npos);
  CHECK(text.find("one: no data has come (mpm/mv ...: nobody writes it on " + place + ")") !=
        std::string::npos);
}

TEST_CASE("mpm doctor says how long it listens where a slow unit has it wait") {
  const TemporaryFolder folder;
  const std::string err = folder.file("err");
  std::string yaml = unit_yaml("slow", 11);
  yaml.replace(yaml.find("1.0"), 3, "60");
  write_file(folder.file("slow.yaml"), yaml);
  Process doctor({"mpm", "doctor", "--config", folder.file("slow.yaml")}, folder.file("out"), err);
  CHECK(idl::eventually(
      [&] { return read_file(err).find("listening for 180 s") != std::string::npos; },
      std::chrono::seconds(20)));
  doctor.send(SIGTERM);
  CHECK(doctor.wait(std::chrono::seconds(20)) == 1);  // what it heard until then
}

TEST_CASE("mpm doctor looks at every unit where its file says") {
  const TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  write_file(folder.file("one.yaml"), unit_yaml("one", 7));
  write_file(folder.file("other.yaml"), unit_yaml("other", 8));
  const std::vector<std::string> look = {"mpm",       "doctor",
                                         "--config",  folder.file("one.yaml"),
                                         "--config",  folder.file("other.yaml"),
                                         "--seconds", "0.3"};
  CHECK(run(look, out, err) == 1);
  const std::string text = read_file(out);
  INFO(text);
  const std::string first = "domain 7, partition 'doctor-test-nobody'";
  const std::string second = "domain 8, partition 'doctor-test-nobody'";
  CHECK(text.find("one on " + first + ": trouble\n") == 0);
  CHECK(text.find("other on " + second + ": trouble\n") != std::string::npos);
  CHECK(text.find("nobody writes it on " + first + ")") != std::string::npos);
  CHECK(text.find("nobody writes it on " + second + ")") != std::string::npos);

  std::vector<std::string> as_json = look;
  as_json.emplace_back("--json");
  CHECK(run(as_json, out, err) == 1);
  const nlohmann::json json = nlohmann::json::parse(read_file(out));
  REQUIRE(json["units"].size() == 2);
  CHECK(json["units"][0]["place"] == first);
  CHECK(json["units"][1]["place"] == second);
  CHECK(json["all_well"] == false);
}

}  // namespace mpm::test
