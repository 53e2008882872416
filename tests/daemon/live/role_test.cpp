#include "daemon/live/role.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "idl/reader.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::live::role_test {
namespace {

using Clock = Role::Clock;

/// A process that shares units, as far as who speaks is settled in it.
struct Sharer {
  Sharer(const idl::DomainOptions& options, const std::vector<std::string>& units, int rank,
         const std::string& pid)
      : participant(options), reader(participant, idl::kRoleTopic, idl::role_reader_qos()) {
    for (const std::string& unit : units)
      roles[unit] =
          std::make_unique<Role>(participant, unit, idl::Process{"host", "mpmd", pid}, rank);
  }

  void turn() {
    const Clock::time_point now = Clock::now();
    for (const auto& [unit, role] : roles) role->say(now, 0);
    reader.take_with_info([&](const mpm_Role& sample, const idl::SampleInfo& info) {
      if (const auto it = roles.find(sample.unit); info.valid && it != roles.end())
        it->second->hear(sample, info.writer);
    });
    for (const auto& [unit, role] : roles) role->settle(now, 0);
  }
  [[nodiscard]] bool speaks(const std::string& unit) const { return roles.at(unit)->active(); }

  idl::Participant participant;
  idl::Reader<mpm_Role> reader;
  std::map<std::string, std::unique_ptr<Role>> roles;
};

/// Until `done`, as often as the service does; false after ten seconds.
template <class Done>
bool turn_until(const std::vector<Sharer*>& sharers, const Done& done) {
  return idl::eventually([&] {
    for (Sharer* sharer : sharers) sharer->turn();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return done();
  });
}

TEST_CASE("of several that share a unit one speaks, and another goes on when it hangs or leaves") {
  const idl::DomainOptions options = idl::test_domain("role");
  auto low = std::make_unique<Sharer>(options, std::vector<std::string>{"a", "b"}, 0, "1");
  auto high = std::make_unique<Sharer>(options, std::vector<std::string>{"a"}, 7, "2");
  CHECK_FALSE(low->speaks("a"));
  REQUIRE(
      turn_until({low.get(), high.get()}, [&] { return high->speaks("a") && low->speaks("b"); }));
  CHECK_FALSE(low->speaks("a"));
  CHECK(low->roles["a"]->speaker() == "mpmd (process 2 on host host)");

  // It hangs; when it goes on the greater rank of two that speak has it again.
  REQUIRE(turn_until({low.get()}, [&] { return low->speaks("a"); }));
  REQUIRE(
      turn_until({low.get(), high.get()}, [&] { return high->speaks("a") && !low->speaks("a"); }));

  // It leaves; who comes back, of whatever rank, stands by.
  high.reset();
  REQUIRE(turn_until({low.get()}, [&] { return low->speaks("a"); }));
  high = std::make_unique<Sharer>(options, std::vector<std::string>{"a"}, 1000, "3");
  const Clock::time_point end = Clock::now() + std::chrono::seconds(4);
  REQUIRE(turn_until({low.get(), high.get()}, [&] { return Clock::now() > end; }));
  CHECK(low->speaks("a"));
  CHECK_FALSE(high->speaks("a"));
}

}  // namespace
}  // namespace mpm::live::role_test
