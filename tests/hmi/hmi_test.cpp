#include <catch2/catch.hpp>

#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

const std::string kScripts = MPM_SOURCE_DIR "/tests/hmi/";
const std::string kPrograms = MPM_HMI_DIR "/";

/// What clients need: the shipped network settings with the test's own partition, and our programs.
std::vector<std::string> environment(const Bench& bench) {
  std::string xml = read_file(kScripts + "loopback.xml");
  const std::size_t at = xml.find("<Discovery>") + std::string("<Discovery>").size();
  xml.insert(at, "<Tag>" + bench.options.partition + "</Tag>");
  write_file(bench.folder.file("loopback.xml"), xml);
  return {"CYCLONEDDS_URI=file://" + bench.folder.file("loopback.xml"),
          "PATH=" MPM_BIN_DIR ":/usr/bin:/bin"};
}

}  // namespace

TEST_CASE("clients in C, C++ and Python see the alarm that a gateway in C or C++ brings about") {
  const std::string program = GENERATE("hmi_gateway_c", "hmi_gateway_cpp");
  CAPTURE(program);
  Bench bench(program);
  const std::vector<std::string> around = environment(bench);
  const std::string domain = std::to_string(bench.options.domain);
  const auto file = [&](const char* name) { return bench.folder.file(name); };
  const Process c({kPrograms + "hmi_alarms_c", domain, "60"}, file("c.out"), file("c.err"), around);
  const Process cpp({kPrograms + "hmi_alarms_cpp", domain, "60"}, file("cpp.out"), file("cpp.err"),
                    around);
  const Process python(
      {kScripts + "alarms.py", domain, "60", "--partition", bench.options.partition},
      file("py.out"), file("py.err"), around);
  Process gateway({kPrograms + program, domain, "toy", "3000", "1"}, file("gateway.out"),
                  file("gateway.err"), around);
  INFO(read_file(file("gateway.err")));
  CHECK(gateway.wait(std::chrono::seconds(60)) == 0);
  CHECK(bench.observe([&] { return bench.health().active_alarms == 1; }));
  for (const char* output : {"c.out", "cpp.out", "py.out"})
    CHECK(idl::eventually(
        [&] { return read_file(file(output)).find("alarm toy u1 y1 active") != std::string::npos; },
        std::chrono::seconds(10)));
  // It says what its values are, and that is what the unit file says.
  CHECK(read_file(file("mpmd.err")).find("layout") == std::string::npos);
}

TEST_CASE("a gateway in Python needs a pipe only") {
  Bench bench("hmi-py");
  const auto file = [&](const char* name) { return bench.folder.file(name); };
  Process gateway({kScripts + "gateway.py", file("toy.yaml"), "3000", "--domain",
                   std::to_string(bench.options.domain), "--partition", bench.options.partition},
                  file("gateway.out"), file("gateway.err"), environment(bench));
  CHECK(gateway.wait(std::chrono::seconds(60)) == 0);
  INFO(read_file(file("gateway.err")));
  CHECK(bench.observe([&] { return bench.health().frames >= 2999; }));
  CHECK(bench.observe([&] { return bench.health().active_alarms == 1; }));
}

}  // namespace mpm::test
