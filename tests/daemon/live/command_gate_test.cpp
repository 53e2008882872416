#include "daemon/live/command_gate.hpp"

#include <catch2/catch.hpp>

namespace mpm::live::command_gate_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kNow = 1'800'000'000 * kSecond;
const host::CommandToken kToken("0123456789abcdef");

CommandRecord signed_by(const host::CommandToken& token, CommandRecord record = {}) {
  if (record.id.empty()) record.id = "1";
  if (record.action.empty()) record.action = "acknowledge";
  if (record.user.empty()) record.user = "ann";
  if (record.time_ns == 0) record.time_ns = kNow;
  record.proof = token.proof(signed_text(record));
  return record;
}

/// Why it was refused; empty: it was not.
std::string refused(CommandGate& gate, const CommandRecord& record, std::int64_t now = kNow) {
  const auto admitted = gate.admit(record, now);
  return std::holds_alternative<AlarmCommand>(admitted) ? "" : std::get<std::string>(admitted);
}
using Catch::Matchers::Contains;

TEST_CASE("who knows the token gives a command, and it comes as it was given") {
  CommandGate gate(kToken);
  CommandRecord record;
  record.mv = "u1";
  record.cv = "y1";
  record.action = "shelve";
  record.duration_s = 60;
  record.once = true;
  record.user = "ann";
  record.comment = "line\nfeed";
  const auto admitted = gate.admit(signed_by(kToken, record), kNow);
  REQUIRE(std::holds_alternative<AlarmCommand>(admitted));
  const AlarmCommand& command = std::get<AlarmCommand>(admitted);
  CHECK(command.action == AlarmAction::kShelve);
  CHECK(command.mv == "u1");
  CHECK(command.duration_s == 60.0);
  CHECK(command.once);
  CHECK(command.user == "ann");
  CHECK(command.comment == "line\\nfeed");
}

TEST_CASE("a command of nobody is refused") {
  CommandGate gate(kToken);
  CommandRecord record = signed_by(kToken);
  record.user = "";
  record.proof = kToken.proof(signed_text(record));
  CHECK_THAT(refused(gate, record), Contains("user is missing"));
}

TEST_CASE("without a token nobody gives commands, with another one neither") {
  CommandGate closed(std::nullopt);
  CHECK_THAT(refused(closed, signed_by(kToken)), Contains("--token-file"));
  CommandGate gate(kToken);
  CHECK_THAT(refused(gate, signed_by(host::CommandToken("fedcba9876543210"))),
             Contains("the token is not"));
  CommandRecord unsigned_record = signed_by(kToken);
  unsigned_record.proof = "";
  CHECK_THAT(refused(gate, unsigned_record), Contains("the token is not"));
}

TEST_CASE("a command that was changed on its way is refused") {
  CommandGate gate(kToken);
  CommandRecord record = signed_by(kToken);
  record.cv = "y2";
  CHECK_THAT(refused(gate, record), Contains("the token is not"));
}

TEST_CASE("a command is obeyed once, and only while it is fresh") {
  CommandGate gate(kToken);
  const CommandRecord record = signed_by(kToken);
  CHECK(refused(gate, record).empty());
  CHECK_THAT(refused(gate, record), Contains("given before"));
  for (const std::int64_t late : {-61, 61}) {
    CommandRecord other;
    other.id = "late";
    other.time_ns = kNow + late * kSecond;
    CHECK_THAT(refused(gate, signed_by(kToken, other)), Contains("clocks"));
  }
  // Nor when it is forgotten that it was obeyed.
  for (int i = 0; i < 300; ++i) {
    CommandRecord other;
    other.id = "other " + std::to_string(i);
    other.time_ns = kNow + i * kSecond;
    CHECK(refused(gate, signed_by(kToken, other), other.time_ns).empty());
    CHECK_FALSE(refused(gate, record, other.time_ns).empty());
  }
}

TEST_CASE("an action that there is not is refused in words") {
  CommandGate gate(kToken);
  CommandRecord record;
  record.action = "explode\n";
  CHECK(refused(gate, signed_by(kToken, record)) == "there is no action 'explode\\n'");
}

}  // namespace
}  // namespace mpm::live::command_gate_test
