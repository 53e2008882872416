#include <catch2/catch.hpp>
#include <csignal>
#include <set>

#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

using idl::Writer;

struct RawSample {
  std::string unit;
  std::int64_t interval;
  std::vector<double> values;
};

bool write(const Writer<mpm_Sample>& writer, RawSample raw) {
  mpm_Sample sample{};
  sample.unit = raw.unit.data();
  sample.interval = raw.interval;
  sample.source_time_ns = raw.interval * 1'000'000'000;
  const auto count = static_cast<std::uint32_t>(raw.values.size());
  sample.values = {count, count, raw.values.data(), false};
  return writer.write(sample);
}

}  // namespace

TEST_CASE("what is wrong with the input is counted in the health, without a flood of messages") {
  Bench bench("counters");
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(publisher, plant, 30);  // intervals 1..30
  REQUIRE(bench.observe([&] { return bench.health().frames == 30; }));

  const Writer<mpm_Sample> mv(bench.participant, "mpm/mv",
                              idl::sample_writer_qos(idl::WriterPace::kLossless));
  const Writer<mpm_Sample> cv(bench.participant, "mpm/cv",
                              idl::sample_writer_qos(idl::WriterPace::kLossless));
  REQUIRE(idl::eventually([&] { return mv.matched_readers() > 0 && cv.matched_readers() > 0; }));
  // Volatile: repeat until it is certain that the daemon knows the new writer.
  REQUIRE(bench.observe([&] {
    return write(mv, {"stranger", 1, {1.0, 2.0}}) && bench.health().unknown_unit > 0;
  }));
  for (int i = 0; i < 100; ++i) REQUIRE(write(mv, {"toy", 31, {1.0}}));     // wrong length
  for (int i = 0; i < 3; ++i) REQUIRE(write(mv, {"toy", 30, {1.0, 2.0}}));  // repeated
  REQUIRE(write(mv, {"toy", 0, {1.0, 2.0}}));                               // late
  REQUIRE(write(mv, {"toy", 32, {1.0, 2.0}}));
  REQUIRE(write(mv, {"toy", 31, {1.0, 2.0}}));  // out of order
  for (int k = 33; k <= 45; ++k) REQUIRE(write(mv, {"toy", k, {1.0, 2.0}}));
  for (int k = 31; k <= 45; ++k)
    if (k != 35) REQUIRE(write(cv, {"toy", k, {1.0}}));  // incomplete

  CHECK(bench.observe([&] { return bench.health().frames == 45; }));
  const HealthRecord health = bench.health();
  CHECK(health.wrong_length == 100);
  CHECK(health.repeated == 3);
  CHECK(health.late == 1);
  CHECK(health.out_of_order == 1);
  CHECK(health.incomplete == 1);
  CHECK(health.restarts == 0);

  const std::vector<std::string> log = lines_of(read_file(bench.folder.file("mpmd.err")));
  CHECK(log.size() < 30);
}

TEST_CASE("a topic that falls silent is given up after a while") {
  Bench bench("silent");
  const Writer<mpm_Sample> mv(bench.participant, "mpm/mv",
                              idl::sample_writer_qos(idl::WriterPace::kLossless));
  const Writer<mpm_Sample> cv(bench.participant, "mpm/cv",
                              idl::sample_writer_qos(idl::WriterPace::kLossless));
  REQUIRE(idl::eventually([&] { return mv.matched_readers() > 0 && cv.matched_readers() > 0; }));
  int k = 0;
  REQUIRE(bench.observe([&] {
    ++k;
    return write(mv, {"toy", k, {1.0, 2.0}}) && write(cv, {"toy", k, {1.0}}) &&
           bench.health().frames > 0;
  }));
  const std::uint64_t before = bench.health().frames;
  // MVs only; patience is 8 sample times, the daemon's clock is the wall's.
  REQUIRE(bench.observe([&] {
    ++k;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return write(mv, {"toy", k, {1.0, 2.0}}) && bench.health().incomplete > 0;
  }));
  CHECK(bench.health().frames > before);
  CHECK(bench.health().state == "out_of_specification");
}

TEST_CASE("the daemon writes outputs only: never an input topic, never a layout") {
  Bench bench("readonly");
  const idl::Entity reader(dds_create_reader(bench.participant.get(),
                                             DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
                           "publications");
  std::set<std::string> topics;
  std::size_t gone = 0;
  const auto take = [&] {
    void* samples[64] = {};
    dds_sample_info_t infos[64];
    const int count = dds_take(reader.get(), samples, infos, 64, 64);
    for (int i = 0; i < count; ++i) {
      if (infos[i].valid_data)
        topics.insert(static_cast<dds_builtintopic_endpoint_t*>(samples[i])->topic_name);
      if (infos[i].instance_state != DDS_ALIVE_INSTANCE_STATE) ++gone;
    }
    if (count > 0) dds_return_loan(reader.get(), samples, count);
  };
  CHECK(idl::eventually([&] {
    take();
    return topics.size() >= 7;
  }));
  // A participant tells of its writers in their order: once all have gone there were no others.
  bench.daemon.send(SIGTERM);
  CHECK(bench.daemon.wait(std::chrono::seconds(10)) == 0);
  CHECK(idl::eventually([&] {
    take();
    return gone >= 7;
  }));
  CHECK(gone == 7);
  CHECK(topics == std::set<std::string>{"mpm/alarm", "mpm/alarm_event", "mpm/channel_status",
                                        "mpm/command_reply", "mpm/controller_alarm", "mpm/health",
                                        "mpm/performance"});
}

TEST_CASE("a layout that differs from the unit file is noticed, until it is right") {
  Bench bench("layout");
  UnitLayout layout;
  layout.unit = "toy";
  layout[SignalKind::kMv].tags = {"u2", "u1"};
  layout[SignalKind::kCv].tags = {"y1"};
  std::optional<idl::UnitPublisher> publisher;
  publisher.emplace(bench.participant, layout, idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(*publisher, plant, 30);
  CHECK(bench.observe([&] { return bench.health().state == "out_of_specification"; }));
  CHECK(bench.health().detail.find("layout differs from the unit file: mv (tags or their order) of "
                                   "system_tests (process ") == 0);
  const auto file = [&](const char* name) { return bench.folder.file(name); };
  CHECK(run({"mpm", "doctor", "--domain", std::to_string(bench.options.domain), "--partition",
             bench.options.partition, "--config", file("toy.yaml"), "--seconds", "1"},
            file("out"), file("err")) == 1);
  CHECK(read_file(file("out")).find(". toy: layout differs from the unit file: mv (tags") !=
        std::string::npos);

  // A gateway that was put right takes its place.
  publisher.reset();
  const idl::UnitPublisher right = bench.publisher(idl::WriterPace::kLossless);
  bench.publish(right, plant, 30);
  CHECK(bench.observe([&] { return bench.health().detail == "nothing determined yet"; }));
}

TEST_CASE("partitions do not see each other") {
  Bench bench("partition");
  idl::DomainOptions other = bench.options;
  other.partition += "-other";
  const idl::Participant outsider(other);
  idl::OutputReaders readers(outsider);
  UnitLayout layout;
  layout.unit = "toy";
  layout[SignalKind::kMv].tags = {"u1", "u2"};
  layout[SignalKind::kCv].tags = {"y1"};
  const idl::UnitPublisher publisher(outsider, layout, idl::WriterPace::kRealTime);
  // Who came later on the daemon's side has been found; so would the outsider have been.
  const idl::Participant insider(bench.options);
  const idl::UnitPublisher known(insider, layout, idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(known, plant, 30);
  CHECK(bench.observe([&] { return bench.health().frames == 30; }));
  CHECK_FALSE(publisher.wait_for_readers(std::chrono::milliseconds(0)));
  for (const idl::Output& output : readers.take())
    CHECK(std::holds_alternative<idl::LayoutRecord>(output));  // its own one
}

TEST_CASE("thirty viewers on one host all hear the daemon, without multicast") {
  Bench bench("thirty");
  std::vector<Process> viewers;
  viewers.reserve(30);
  const auto output = [&](int i) { return bench.folder.file("watch" + std::to_string(i)); };
  for (int i = 0; i < 30; ++i)
    viewers.emplace_back(bench.watch({"--json"}), output(i), output(i) + ".err");
  int hearing = 0;
  CHECK(idl::eventually(
      [&] {
        hearing = 0;
        for (int i = 0; i < 30; ++i)
          if (read_file(output(i)).find("\"unit\":\"toy\"") != std::string::npos) ++hearing;
        return hearing == 30;
      },
      std::chrono::seconds(30)));
  CHECK(hearing == 30);
}

}  // namespace mpm::test
