#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/system/bench.hpp"

namespace mpm::test::unit_alarms_test {
namespace {

using Json = nlohmann::json;
constexpr const char* kToken = "0123456789abcdef0123456789abcdef";
constexpr int kFrames = 4000;

/// A monitor that keeps a journal and takes commands, and a plant whose u1 answers too strongly.
struct Office {
  explicit Office(const std::string& test) {
    write_file(folder.file("token"), std::string(kToken) + "\n");
    std::filesystem::permissions(folder.file("token"), std::filesystem::perms::owner_read);
    bench.emplace(test, std::vector<std::string>{"--token-file", folder.file("token"),
                                                 "--alarm-journal", journal()});
  }
  [[nodiscard]] std::string journal() const { return folder.file("alarms.sqlite"); }
  void run_until_alarm() {
    Plant plant(3.0);
    const idl::UnitPublisher publisher = bench->publisher(idl::WriterPace::kLossless);
    bench->publish(publisher, plant, kFrames);
    REQUIRE(bench->observe([&] { return controller().state == AlarmState::kActive; }));
  }
  [[nodiscard]] ControllerAlarmRecord controller() const {
    const auto all = bench->seen<ControllerAlarmRecord>();
    return all.empty() ? ControllerAlarmRecord() : all.back();
  }
  [[nodiscard]] AlarmStateRecord channel(const std::string& mv) const {
    AlarmStateRecord last;
    for (const AlarmStateRecord& alarm : bench->seen<AlarmStateRecord>())
      if (alarm.mv == mv) last = alarm;
    return last;
  }
  /// Exit code of a command of mpm; what it prints is in `out` and `err`.
  int mpm(std::vector<std::string> arguments, bool on_bus = true) {
    arguments.insert(arguments.begin(), "mpm");
    if (on_bus)
      for (const std::string& more :
           {std::string("--domain"), std::to_string(bench->options.domain),
            std::string("--partition"), bench->options.partition, std::string("--unit"),
            std::string("toy")})
        arguments.push_back(more);
    Process process(arguments, folder.file("out"), folder.file("err"),
                    {"MPM_TOKEN_FILE=" + folder.file("token")});
    const std::optional<int> code = process.wait(std::chrono::seconds(20));
    return code.value_or(-1);
  }
  [[nodiscard]] std::string out() const { return read_file(folder.file("out")); }

  TemporaryFolder folder;
  std::optional<Bench> bench;
};

using Catch::Matchers::Contains;

TEST_CASE("an operator acknowledges and shelves, and all of it is in the journal") {
  Office office("alarms-office");
  office.run_until_alarm();
  CHECK(office.controller().view.alarm_state == AlarmWord::kUnacknowledged);
  CHECK(office.controller().channels == 1);
  CHECK_THAT(office.controller().view.message, Contains("the model of u1 -> y1 does not match"));
  CHECK(office.mpm({"alarms"}) == 1);
  CHECK_THAT(office.out(), Contains("toy  unacknowledged"));

  CHECK(office.mpm({"ack", "--comment", "seen", "--user", "ann"}) == 0);
  CHECK(office.out() == "toy: acknowledged\n");
  REQUIRE(office.bench->observe(
      [&] { return office.controller().view.alarm_state == AlarmWord::kAcknowledged; }));
  CHECK(office.controller().view.client_user_id == "ann");
  CHECK(office.controller().view.comment == "seen");
  CHECK(office.controller().view.ack_time_ns > 1'700'000'000'000'000'000);
  CHECK(office.mpm({"ack"}) == 1);

  // The only channel that stands: its controller has nothing left to call for.
  CHECK(office.mpm({"shelve", "--mv", "u1", "--cv", "y1", "--for", "2h"}) == 0);
  CHECK(office.out() == "toy: u1 -> y1: shelved for 2 h\n");
  REQUIRE(office.bench->observe(
      [&] { return office.channel("u1").view.alarm_state == AlarmWord::kShelved; }));
  CHECK(office.channel("u1").to == AlarmChange::kActive);
  REQUIRE(office.bench->observe([&] { return office.controller().state == AlarmState::kCleared; }));
  CHECK(office.mpm({"alarms"}) == 0);
  CHECK(office.mpm({"unshelve", "--mv", "u1", "--cv", "y1"}) == 0);
  CHECK(office.mpm({"out-of-service", "--mv", "u2", "--cv", "y1"}) == 0);

  CHECK(office.mpm({"journal", "--journal", office.journal(), "--export", "json"}, false) == 0);
  std::vector<std::string> happened;
  for (const std::string& line : lines_of(office.out())) {
    const Json entry = Json::parse(line);
    if (entry["what"] != "diagnosed")
      happened.push_back(entry["mv"].get<std::string>() + " " + entry["what"].get<std::string>());
  }
  CHECK(happened == std::vector<std::string>{"u1 active", " active", " acknowledged", " refused",
                                             "u1 shelved", " cleared", "u1 unshelved",
                                             "u2 out_of_service"});
  CHECK(office.mpm({"journal", "--journal", office.journal(), "--verify"}, false) == 0);
  CHECK(office.mpm({"alarms", "stats", "--journal", office.journal()}, false) == 0);
  CHECK_THAT(office.out(), Contains("Engineers (alerts)"));
}

TEST_CASE("who does not know the token changes nothing, and that he tried is kept") {
  Office office("alarms-stranger");
  office.run_until_alarm();
  write_file(office.folder.file("other"), "fedcba9876543210\n");
  std::filesystem::permissions(office.folder.file("other"), std::filesystem::perms::owner_read);
  CHECK(office.mpm({"suppress", "--token-file", office.folder.file("other")}) == 1);
  CHECK_THAT(office.out(), Contains("refused: the token is not the monitor's"));
  CHECK(office.mpm({"suppress", "--token-file", office.folder.file("none")}) == 2);
  CHECK(office.mpm({"alarms"}) == 1);
  CHECK_THAT(office.out(), Contains("toy  unacknowledged"));
  CHECK(office.mpm({"journal", "--journal", office.journal()}, false) == 0);
  CHECK_THAT(office.out(), Contains("suppress: the token is not the monitor's"));
}

TEST_CASE("a monitor without a token takes no commands and says so") {
  Bench bench("alarms-no-token");
  TemporaryFolder folder;
  write_file(folder.file("token"), kToken);
  std::filesystem::permissions(folder.file("token"), std::filesystem::perms::owner_read);
  Process process({"mpm", "ack", "--domain", std::to_string(bench.options.domain), "--partition",
                   bench.options.partition, "--unit", "toy", "--token-file", folder.file("token")},
                  folder.file("out"), folder.file("err"));
  CHECK(process.wait(std::chrono::seconds(20)) == 1);
  CHECK_THAT(read_file(folder.file("out")), Contains("without --token-file"));
}

TEST_CASE("what people did outlives the monitor, and what nobody saw is not lost") {
  Office office("alarms-restart");
  office.run_until_alarm();
  CHECK(office.mpm({"out-of-service", "--mv", "u2", "--cv", "y1", "--comment", "probe"}) == 0);
  CHECK(office.mpm({"shelve", "--mv", "u1", "--cv", "y1", "--once"}) == 0);
  CHECK(office.mpm({"unshelve", "--mv", "u1", "--cv", "y1"}) == 0);
  // What is done is answered at once and written by a thread of its own: no disk delays an answer.
  CHECK(idl::eventually(
      [&] {
        (void)office.mpm({"journal", "--journal", office.journal(), "--export", "json"}, false);
        return office.out().find(R"("unshelved")") != std::string::npos;
      },
      std::chrono::seconds(20)));
  office.bench->daemon.send(SIGKILL);
  (void)office.bench->daemon.wait(std::chrono::seconds(10));
  const Process again({"mpmd", "--config", office.bench->folder.file("toy.yaml"), "--domain",
                       std::to_string(office.bench->options.domain), "--partition",
                       office.bench->options.partition, "--alarm-journal", office.journal()},
                      office.folder.file("again.out"), office.folder.file("again.err"));
  const bool told = idl::eventually(
      [&] {
        (void)office.mpm({"alarms"});
        const std::string out = office.out();
        return out.find("u2 -> y1  out of service") != std::string::npos &&
               out.find("u1 -> y1  returned unacknowledged") != std::string::npos;
      },
      std::chrono::seconds(20));
  CAPTURE(office.out(), read_file(office.folder.file("again.err")));
  CHECK(told);
  CHECK_THAT(office.out(), Contains("probe"));
}

}  // namespace
}  // namespace mpm::test::unit_alarms_test
