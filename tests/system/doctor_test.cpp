#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "idl/sample_view.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test::doctor_test {
namespace {

using Json = nlohmann::json;

std::vector<std::string> mpm(const char* command, const idl::DomainOptions& options,
                             const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "mpm", command, "--domain", std::to_string(options.domain), "--partition", options.partition};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++count;
  return count;
}

bool any_text(const Json& troubles, const std::string& word) {
  return std::any_of(troubles.begin(), troubles.end(), [&](const Json& trouble) {
    return trouble["text"].get<std::string>().find(word) != std::string::npos;
  });
}

}  // namespace

/// Of the bench's unit, beside its own.
void start_another_monitor(const Bench& bench, const TemporaryFolder& folder,
                           std::optional<Process>& monitor) {
  monitor.emplace(std::vector<std::string>{"mpmd", "--config", bench.folder.file("toy.yaml"),
                                           "--domain", std::to_string(bench.options.domain),
                                           "--partition", bench.options.partition},
                  folder.file("out2"), folder.file("err2"));
}

TEST_CASE(
    "health and doctor name the topic that nobody writes and the writer that does not match") {
  TemporaryFolder folder;
  const idl::DomainOptions options = idl::test_domain("doctor-topics");
  std::string yaml = unit_yaml("toy");
  yaml.insert(yaml.find("  cv:"), "  dv:\n    - {tag: d1}\n");
  write_file(folder.file("toy.yaml"), yaml);
  const Process daemon({"mpmd", "--config", folder.file("toy.yaml"), "--domain",
                        std::to_string(options.domain), "--partition", options.partition},
                       folder.file("mpmd.out"), folder.file("mpmd.err"));

  const idl::Participant participant(options);
  UnitLayout layout;
  layout.unit = "toy";
  layout[SignalKind::kMv].tags = {"u1", "u2"};
  const idl::UnitPublisher gateway(participant, layout, idl::WriterPace::kRealTime);
  const idl::Writer<mpm_Sample> best_effort(participant, "mpm/cv", idl::foreign_reader_qos());
  Plant plant(2.0);
  const auto publish = [&] {
    const Frame& frame = plant.next();
    (void)gateway.publish(frame);
    (void)best_effort.write(idl::sample_of("toy", frame, SignalKind::kCv));
  };

  idl::OutputReaders readers(participant);
  std::string detail;
  REQUIRE(idl::eventually(
      [&] {
        publish();
        for (const idl::Output& output : readers.take())
          if (const auto* health = std::get_if<HealthRecord>(&output))
            if (health->detail.find("nothing on") == 0) {
              CHECK(health->state == "out_of_specification");
              detail = health->detail;
            }
        return !detail.empty();
      },
      std::chrono::seconds(20)));
  INFO(detail);
  CHECK(detail.find("nothing on mpm/dv (nobody writes it on domain") != std::string::npos);
  CHECK(detail.find("nothing on mpm/cv (its writer ") != std::string::npos);
  CHECK(detail.find("RELIABILITY (best effort offered, reliable requested)") != std::string::npos);

  Process doctor(
      mpm("doctor", options, {"--config", folder.file("toy.yaml"), "--seconds", "2", "--json"}),
      folder.file("out"), folder.file("err"));
  std::optional<int> code;
  REQUIRE(idl::eventually(
      [&] {
        publish();
        code = doctor.wait(std::chrono::milliseconds(0));
        return code.has_value();
      },
      std::chrono::seconds(20)));
  CHECK(code == 1);
  const Json said = Json::parse(read_file(folder.file("out")));
  CHECK(any_text(said["troubles"], "nothing on mpm/dv (nobody writes it on domain"));
  CHECK(any_text(said["troubles"], "RELIABILITY (best effort offered, reliable requested)"));
  // What the monitor says of them is not told twice.
  CHECK_FALSE(any_text(said["troubles"], " says out_of_specification: "));
  CHECK(said["units"][0]["monitors"][0]["program"] == "mpmd");
  CHECK(said["units"][0]["monitors"][0]["pid"] == std::to_string(daemon.pid()));
  CHECK(said["units"][0]["topics"][0]["writers"][0]["samples"] > 0);
  // Each was logged once, whatever happened each second.
  CHECK(count_of(read_file(folder.file("mpmd.err")), "nothing on mpm/dv") == 1);
}

TEST_CASE("of a unit whose data have stopped the doctor says for how long, as its monitor does") {
  Bench bench("doctor-stopped");
  Plant plant(2.0);
  {
    const idl::UnitPublisher gateway = bench.publisher(idl::WriterPace::kLossless);
    REQUIRE(gateway.wait_for_readers(std::chrono::seconds(20)));
    for (int i = 0; i < 50; ++i) REQUIRE(gateway.publish(plant.next()));
    REQUIRE(bench.observe([&] { return bench.health().frames >= 40; }));
  }
  REQUIRE(bench.observe([&] { return bench.health().detail.find("no data for ") == 0; }));
  TemporaryFolder folder;
  Process doctor(mpm("doctor", bench.options,
                     {"--config", bench.folder.file("toy.yaml"), "--seconds", "2", "--json"}),
                 folder.file("out"), folder.file("err"));
  CHECK(doctor.wait(std::chrono::seconds(20)) == 1);
  const Json said = Json::parse(read_file(folder.file("out")));
  CHECK(any_text(said["troubles"], "no data for "));
  CHECK_FALSE(any_text(said["troubles"], "no data has come"));
  CHECK(said["troubles"][0]["severity"] == "failure");
}

TEST_CASE("two gateways with counters of their own are named, and do not flood the log") {
  Bench bench("doctor-gateways");
  const idl::UnitPublisher one = bench.publisher(idl::WriterPace::kLossless);
  const idl::UnitPublisher other = bench.publisher(idl::WriterPace::kLossless);
  REQUIRE(one.wait_for_readers(std::chrono::seconds(20)));
  REQUIRE(other.wait_for_readers(std::chrono::seconds(20)));
  Plant plant(2.0), other_plant(2.0);
  std::string detail;
  CHECK(bench.observe([&] {
    for (int i = 0; i < 20; ++i) {
      REQUIRE(one.publish(plant.next()));
      Frame frame = other_plant.next();
      frame.interval += 1'000'000;
      REQUIRE(other.publish(frame));
    }
    detail = bench.health().detail;
    return detail.find("two gateways") != std::string::npos && bench.health().late > 1000;
  }));
  INFO(detail);
  // The one that was there first goes on, so that no controller restarted.
  CHECK(bench.health().restarts == 0);
  CHECK(bench.health().state == "out_of_specification");  // with verdicts, of that one's samples
  CHECK(detail.find("with other interval numbers") != std::string::npos);
  CHECK(lines_of(read_file(bench.folder.file("mpmd.err"))).size() < 20);
}

TEST_CASE("a monitor that stood still itself says so") {
  Bench bench("doctor-standstill");
  // Also while samples wait for it, which are the first thing that it sees.
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kRealTime);
  Plant plant(2.0);
  const bool data = GENERATE(false, true);
  if (data) bench.publish(publisher, plant, 30);
  REQUIRE(bench.observe([&] { return bench.health().frames == (data ? 30u : 0u); }));
  bench.daemon.send(SIGSTOP);
  if (data) bench.publish(publisher, plant, 3);  // before it is taken for dead
  std::this_thread::sleep_for(std::chrono::milliseconds(5500));
  bench.daemon.send(SIGCONT);
  CHECK(bench.observe([&] {
    return bench.health().detail.find("the monitor itself stood still for ") != std::string::npos;
  }));
  CHECK(bench.health().state == "out_of_specification");
}

TEST_CASE("a monitor that starts and leaves beside another one takes none of its alarms along") {
  TemporaryFolder folder;
  Bench bench("doctor-second");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(3.5);
  bench.publish(publisher, plant, 600);
  const auto states = [&](const char* mv) {
    std::vector<AlarmChange> to;
    for (const auto& alarm : bench.seen<AlarmStateRecord>())
      if (alarm.mv == mv) to.push_back(alarm.to);
    return to;
  };
  const std::vector<AlarmChange> active = {AlarmChange::kCleared, AlarmChange::kActive};
  REQUIRE(bench.observe([&] { return states("u1") == active; }));
  REQUIRE(states("u2") == std::vector{AlarmChange::kCleared});

  std::optional<Process> second;
  start_another_monitor(bench, folder, second);
  // It clears both, and the first one says again what stands.
  CHECK(bench.observe([&] {
    const auto to = states("u1");
    return to.size() > 3 && to[2] == AlarmChange::kCleared && to.back() == AlarmChange::kActive &&
           to[to.size() - 2] == AlarmChange::kActive;
  }));
  REQUIRE(states("u2").size() == 2);
  second->send(SIGTERM);
  CHECK(second->wait(std::chrono::seconds(10)) == 0);
  CHECK(bench.observe([&] { return states("u2").size() == 3; }));
  CHECK(states("u1").back() == AlarmChange::kActive);
}

// It was heard, and no topic is silent yet: that takes five seconds.
TEST_CASE("a gateway that leaves under the doctor's eyes is missed at once") {
  TemporaryFolder folder;
  Bench bench("doctor-left");
  std::optional<Process> doctor;
  {
    const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
    Plant plant(2.0);
    bench.publish(publisher, plant, 100);
    doctor.emplace(mpm("doctor", bench.options,
                       {"--config", bench.folder.file("toy.yaml"), "--seconds", "4", "--json"}),
                   folder.file("out"), folder.file("err"));
    for (int i = 0; i < 20; ++i) {
      bench.publish(publisher, plant, 10);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  CHECK(doctor->wait(std::chrono::seconds(20)) == 1);
  const Json said = Json::parse(read_file(folder.file("out")));
  INFO(said.dump(1));
  CHECK(any_text(said["troubles"], "nobody writes mpm/cv"));
}

TEST_CASE("a clock that is off is told once for its process, not for each topic") {
  TemporaryFolder folder;
  Bench bench("doctor-clock");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  const auto offset_ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(
          (std::chrono::system_clock::now() + std::chrono::hours(1)).time_since_epoch())
          .count();
  Process doctor(mpm("doctor", bench.options,
                     {"--config", bench.folder.file("toy.yaml"), "--seconds", "2", "--json"}),
                 folder.file("out"), folder.file("err"));
  std::optional<int> code;
  REQUIRE(idl::eventually(
      [&] {
        Frame frame = plant.next();
        frame.source_time_ns += offset_ns;
        (void)publisher.publish(frame);
        code = doctor.wait(std::chrono::milliseconds(20));
        return code.has_value();
      },
      std::chrono::seconds(20)));
  CHECK(code == 1);
  const Json said = Json::parse(read_file(folder.file("out")));
  INFO(said.dump(1));
  CHECK(std::count_if(said["troubles"].begin(), said["troubles"].end(), [](const Json& trouble) {
          const auto text = trouble["text"].get<std::string>();
          return text.find("ahead of this machine's clock") != std::string::npos;
        }) == 1);
}

TEST_CASE("doctor tells what ails a monitor beside its alarms") {
  TemporaryFolder folder;
  Bench bench("doctor-alarms", {"--journal-every-sample", "/dev/full"});
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(3.5);
  bench.publish(publisher, plant, 600);
  REQUIRE(bench.observe([&] { return bench.health().active_alarms == 1; }));
  CHECK(run(mpm("doctor", bench.options,
                {"--config", bench.folder.file("toy.yaml"), "--seconds", "2", "--json"}),
            folder.file("out"), folder.file("err")) == 1);
  const Json said = Json::parse(read_file(folder.file("out")));
  CHECK(any_text(said["troubles"], "the journal of every sample cannot be written: No space left"));
}

TEST_CASE("two monitors of one unit say so in the same words, so that readers see them stand") {
  TemporaryFolder folder;
  Bench bench("doctor-in-turn");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(publisher, plant, 20);
  std::optional<Process> second;
  start_another_monitor(bench, folder, second);
  const auto said = [&] {
    std::vector<std::string> texts;
    for (const auto& health : bench.seen<HealthRecord>())
      if (const auto at = health.detail.find("2 monitors watch"); at != std::string::npos)
        texts.push_back(health.detail.substr(at, health.detail.find("in turn", at) - at));
    return texts;
  };
  REQUIRE(bench.observe([&] { return said().size() >= 6; }));
  for (const std::string& text : said()) {
    CHECK(text == said().front());
    CHECK(text.find("mpmd (process " + std::to_string(second->pid())) != std::string::npos);
    CHECK(text.find("mpmd (process " + std::to_string(bench.daemon.pid())) != std::string::npos);
  }
}

TEST_CASE("two monitors of one unit, and what the disk does not take, are in health and status") {
  TemporaryFolder folder;
  Bench bench("doctor-monitors",
              {"--journal-every-sample", "/dev/full", "--state-dir", "/proc/none"},
              {"CYCLONEDDS_URI=file:///none"});
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(publisher, plant, 20);
  const auto said = [&](const char* word) {
    for (const auto& health : bench.seen<HealthRecord>())
      if (health.detail.find(word) != std::string::npos) return true;
    return false;
  };
  CHECK(bench.observe(
      [&] { return said("the journal of every sample cannot be written: No space left"); }));
  CHECK(said("reports of diagnoses cannot be kept: /proc/none"));

  std::optional<Process> second;
  start_another_monitor(bench, folder, second);
  CHECK(bench.observe([&] {
    return said(("mpmd (process " + std::to_string(second->pid())).c_str()) &&
           said(("mpmd (process " + std::to_string(bench.daemon.pid())).c_str());
  }));
  const std::string log = read_file(bench.folder.file("mpmd.err"));
  CHECK(count_of(log, "2 monitors watch this unit: ") == 1);
  CHECK(count_of(log, "the journal of every sample cannot be written") == 1);
  CHECK(count_of(log, "CYCLONEDDS_URI is set, but") == 1);

  const std::string out = folder.file("out"), err = folder.file("err");
  CHECK(run(mpm("status", bench.options, {"--unit", "toy"}), out, err) == 1);
  CHECK(read_file(out).find("MPM WARNING: toy: ") == 0);
  CHECK(read_file(out).find(" | 'toy alarms'=0;0 'toy age'=") != std::string::npos);
  CHECK(run(mpm("status", bench.options, {"--unit", "none", "--wait", "1"}), out, err) == 2);
  CHECK(run(mpm("status", bench.options, {"--no-such-option"}), out, err) == 3);
}

}  // namespace mpm::test::doctor_test
