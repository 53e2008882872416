#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

struct Corner {
  TemporaryFolder folder;
  idl::DomainOptions domain = idl::test_domain("alarm-action");

  Corner() {
    write_file(folder.file("token"), "0123456789abcdef\n");
    std::filesystem::permissions(folder.file("token"), std::filesystem::perms::owner_read);
  }
  int run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "mpm");
    for (const std::string& more : {std::string("--domain"), std::to_string(domain.domain),
                                    std::string("--partition"), domain.partition})
      arguments.push_back(more);
    Process process(arguments, folder.file("out"), folder.file("err"),
                    {"MPM_TOKEN_FILE=" + folder.file("token")});
    return process.wait(std::chrono::seconds(20)).value_or(-1);
  }
  [[nodiscard]] std::string err() const { return read_file(folder.file("err")); }
};
using Catch::Matchers::Contains;

TEST_CASE("where no monitor is, nobody waits for ever") {
  const Corner corner;
  CHECK(corner.run({"ack", "--unit", "toy", "--wait", "0.2"}) == 2);
  CHECK_THAT(corner.err(), Contains("nobody takes commands on"));
  CHECK(corner.run({"alarms", "--wait", "0.2"}) == 2);
  CHECK_THAT(corner.err(), Contains("no monitor"));
}

TEST_CASE("a command without a unit, half a channel or a token is refused") {
  const Corner corner;
  CHECK(corner.run({"ack"}) == 3);
  CHECK(corner.run({"ack", "--unit", "toy", "--mv", "u1"}) == 3);
  CHECK(corner.run({"shelve", "--unit", "toy", "--for", "-1h"}) == 3);
  CHECK(corner.run({"ack", "--unit", "toy", "--all", "--mv", "u1", "--cv", "y1"}) == 3);
  CHECK(corner.run({"ack", "--unit", "toy", "--token-file", corner.folder.file("none")}) == 2);
  CHECK_THAT(corner.err(), Contains("No such file"));
}

}  // namespace
}  // namespace mpm::test
