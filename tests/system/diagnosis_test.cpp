#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <map>
#include <sstream>
#include <system_error>

#include "daemon/files/folder_name.hpp"
#include "idl/output_readers.hpp"
#include "tests/idl/test_domain.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::diagnosis_test {
namespace {

using namespace std::chrono_literals;

const std::string kUnit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

/// mpmd and mpmsim on Shell 3x3, in a corner of the network of their own.
struct Plant {
  explicit Plant(const std::string& test)
      : domain(idl::test_domain(test)),
        monitor({"mpmd", "--config", kUnit, "--domain", std::to_string(domain.domain),
                 "--partition", domain.partition, "--state-dir", folder.file("state")},
                folder.file("mpmd.out"), folder.file("mpmd.err")),
        participant(domain) {}

  [[nodiscard]] Process simulate(const std::string& scenario, int seed, int samples, int speed) {
    return {{"mpmsim", "--config", kUnit, "--scenario", scenario, "--seed", std::to_string(seed),
             "--samples", std::to_string(samples), "--speed", std::to_string(speed), "--start-time",
             "0", "--wait-readers", "20", "--domain", std::to_string(domain.domain), "--partition",
             domain.partition},
            folder.file("sim.out"),
            folder.file("sim.err")};
  }
  [[nodiscard]] std::string log() const { return read_file(folder.file("mpmd.err")); }

  TemporaryFolder folder;
  idl::DomainOptions domain;
  Process monitor;
  idl::Participant participant;
};

/// From a sample's being written to its judgement's, by interval: both ends say when they wrote.
class Latencies {
 public:
  explicit Latencies(const idl::Participant& participant)
      : samples_(participant, "mpm/cv", idl::sample_reader_qos()),
        status_(participant, idl::kChannelStatusTopic, idl::channel_status_reader_qos(), 4096),
        events_(participant, idl::kAlarmEventTopic, idl::alarm_event_reader_qos()) {}

  void take() {
    samples_.take_with_info([this](const mpm_Sample& sample, const idl::SampleInfo& info) {
      if (info.valid) written_[sample.interval] = info.source_time_ns;
    });
    status_.take_with_info([this](const mpm_ChannelStatus& status, const idl::SampleInfo& info) {
      if (info.valid) judged_.emplace(status.interval, info.source_time_ns);
    });
    events_.take_with_info([this](const mpm_AlarmEvent& event, const idl::SampleInfo& info) {
      if (!info.valid || event.to != std::string("diagnosed")) return;
      diagnosed_.emplace_back(event.interval, info.source_time_ns);
    });
  }
  /// In ms; `during` a diagnosis or while there is none.
  [[nodiscard]] std::vector<double> sorted(bool during) const {
    std::vector<double> result;
    for (const auto& [interval, at] : judged_) {
      const auto written = written_.find(interval);
      if (written == written_.end() || in_diagnosis(interval, at) != during) continue;
      result.push_back(1e-6 * static_cast<double>(at - written->second));
    }
    std::sort(result.begin(), result.end());
    return result;
  }
  [[nodiscard]] bool any_diagnosis() const { return !diagnosed_.empty(); }

 private:
  // A diagnosis begins when its last sample was judged, and ends when it is published.
  [[nodiscard]] bool in_diagnosis(std::int64_t interval, std::int64_t at) const {
    return std::any_of(diagnosed_.begin(), diagnosed_.end(), [=](const auto& diagnosis) {
      return interval > diagnosis.first && at < diagnosis.second;
    });
  }

  idl::Reader<mpm_Sample> samples_;
  idl::Reader<mpm_ChannelStatus> status_;
  idl::Reader<mpm_AlarmEvent> events_;
  std::map<std::int64_t, std::int64_t> written_, judged_;         // ns, by interval
  std::vector<std::pair<std::int64_t, std::int64_t>> diagnosed_;  // last interval, published
};

double at(const std::vector<double>& sorted, double share) {
  return sorted.at(static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1)));
}

/// CPU time of the daemon's thread that diagnoses.
double diagnosis_seconds(const Process& daemon) {
  std::error_code error;
  for (const auto& task : std::filesystem::directory_iterator(
           "/proc/" + std::to_string(daemon.pid()) + "/task", error)) {
    if (read_file(task.path() / "comm") != "mpm-diagnosis\n") continue;
    std::istringstream fields(read_file(task.path() / "stat"));
    std::string field;
    for (int i = 1; i < 14; ++i) fields >> field;
    double ticks = 0.0;
    fields >> ticks;
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  return 0.0;
}

}  // namespace

TEST_CASE("an alarm gets its cause, who joins later sees it, and no sample waits for it") {
  // Seed 1 hides a gain of u3 -> y1 that is 0.6 of the model's; its alarm rises after 800 samples.
  Plant plant("diagnosis");
  Latencies latencies(plant.participant);
  Process simulator = plant.simulate("hidden_gain", 1, 1700, 200);
  REQUIRE(idl::eventually(
      [&] {
        latencies.take();
        return simulator.wait(0ms) == 0;
      },
      20s));
  INFO(plant.log());
  REQUIRE(idl::eventually(
      [&] {
        latencies.take();
        return latencies.any_diagnosis();
      },
      30s));  // of which a busy machine leaves it little

  // A monitor that diagnoses between two samples would judge none while it does.
  const std::vector<double> during = latencies.sorted(true), without = latencies.sorted(false);
  REQUIRE(during.size() > 20);
  WARN("ms from sample to status, median, 95 % and largest: "
       << at(during, 0.5) << ", " << at(during, 0.95) << ", " << during.back()
       << " during a diagnosis (" << during.size() << " samples), " << at(without, 0.5) << ", "
       << at(without, 0.95) << ", " << without.back() << " without");

  const idl::Participant newcomer(plant.domain);
  idl::OutputReaders late(newcomer);
  AlarmRecord alarm;
  HealthRecord health;
  CHECK(idl::eventually([&] {
    for (const idl::Output& output : late.take()) {
      if (const auto* state = std::get_if<AlarmStateRecord>(&output))
        if (!state->named.text.empty()) alarm = *state;
      if (const auto* record = std::get_if<HealthRecord>(&output)) health = *record;
    }
    return !alarm.unit.empty() && health.frames == 1700;
  }));
  CHECK(health.missing + health.incomplete + health.late + health.out_of_order == 0);
  CHECK(alarm.to == AlarmChange::kActive);
  CHECK(alarm.mv == "u3");
  CHECK(alarm.cv == "y1");
  CHECK(alarm.named.cause == "gain");
  CHECK(alarm.named.text.find("y1 answers u3") == 0);
  CHECK(alarm.named.confidence > 0.8);
  REQUIRE(alarm.named.parameters.size() == 1);
  const CauseParameter& ratio = alarm.named.parameters[0];
  CHECK(ratio.name == "gain_ratio");
  CHECK(ratio.value == Approx(0.6).margin(0.05));
  CHECK(ratio.low < ratio.value);
  CHECK(ratio.high > ratio.value);

  const std::string report =
      plant.folder.file("state/shell/" + files::time_folder(alarm.source_time_ns) + "/");
  CHECK(read_file(report + "report.json").find("\"cause\": \"gain\"") != std::string::npos);
  CHECK(read_file(report + "report.html").find("</html>") != std::string::npos);
  CHECK(run({"mpmd", "--check", "--config", report + "extended.yaml"},
            plant.folder.file("check.out"), plant.folder.file("check.err")) == 0);
  CHECK(open_to_others(plant.folder.file("state")) == std::vector<std::string>{});
}

TEST_CASE("SIGTERM ends the daemon within a second, also in the middle of a diagnosis") {
  // Seed 5 is diagnosed at the end of the run, which takes seconds of so many samples.
  Plant plant("stopped");
  write_file(plant.folder.file("change.yaml"),
             "scenario: change\n"
             "changes:\n"
             "  - {cv: 1, mv: 3, gain_ratio: 0.6, from: 3000 samples}\n");
  CHECK(plant.simulate(plant.folder.file("change.yaml"), 5, 4900, 0).wait(40s) == 0);
  INFO(plant.log());
  REQUIRE(idl::eventually([&] { return diagnosis_seconds(plant.monitor) > 0.0; }, 15s));
  plant.monitor.send(SIGTERM);
  CHECK(plant.monitor.wait(1s) == 0);
  CHECK(plant.log().find("alarm active") != std::string::npos);
  CHECK(plant.log().find("diagnosed up to") == std::string::npos);  // it was running
}

}  // namespace mpm::test::diagnosis_test
