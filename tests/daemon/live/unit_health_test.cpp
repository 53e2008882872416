#include "daemon/live/unit_health.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "config/load_unit.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::live::unit_health_test {
namespace {

using bus::Severity;
using std::chrono::seconds;

const UnitHealth::Clock::time_point kStart{seconds(1000)};

struct Toy {
  explicit Toy(double sample_time_s, const std::string& cv = "y")
      : loaded(config::load_unit_text("unit: toy\nsample_time: " + std::to_string(sample_time_s) +
                                          "\nsignals: {mv: [u], cv: [" + cv +
                                          "]}\n"
                                          "model: {channels: [{cv: y, mv: u, gain: 2, "
                                          "time_constants: [" +
                                          std::to_string(5 * sample_time_s) + "]}]}\n",
                                      "toy.yaml")),
        monitor(loaded.config),
        health(loaded.config, kStart) {
    REQUIRE(loaded.ok());
  }

  HealthRecord judge(int s, std::vector<bus::Trouble> others = {}, const std::string& front = "") {
    health.go_on(kStart + seconds(s));
    return health.judge({aligner, monitor, 3, around, std::move(others), front, silenced_alarms},
                        1'700'000'000 + s);
  }

  config::LoadResult loaded;
  report::UnitMonitor monitor;
  AlignerCounters aligner;
  bus::Surroundings around;
  std::uint32_t silenced_alarms = 0;
  UnitHealth health;
};

void have_come(Toy& toy, int s) {
  const std::vector<double> value = {1.0};
  toy.health.go_on(kStart + seconds(s));
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv}) {
    idl::SampleView sample;
    sample.kind = kind;
    sample.interval = static_cast<std::int64_t>(toy.aligner.frames);
    sample.source_time_ns = s * std::int64_t{1'000'000'000};
    sample.values = value;
    toy.health.push(sample, 0);
  }
  ++toy.aligner.frames;
}

}  // namespace

TEST_CASE("health says first that nothing has come, then that nothing is determined") {
  Toy toy(1.0);
  CHECK(toy.judge(1).detail == bus::kNoCompleteData);
  CHECK(toy.judge(1).state == "function_check");
  for (int s = 2; s < 5; ++s) have_come(toy, s);
  const HealthRecord record = toy.judge(5);
  CHECK(record.state == "function_check");
  CHECK(record.detail == bus::kNothingDetermined);
  CHECK(record.frames == 3);
  CHECK(record.unknown_unit == 3);
  CHECK(record.undetermined == 1);
  CHECK(toy.health.trouble_text().empty());
}

TEST_CASE(
    "what has come is counted between two judgements too, and nothing is lost to them by that") {
  Toy toy(1.0);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  (void)toy.judge(5);
  have_come(toy, 6);
  toy.aligner.incomplete = 1;
  toy.aligner.without[static_cast<std::size_t>(SignalKind::kCv)] = 1;
  toy.health.count(toy.aligner, toy.monitor);
  CHECK(toy.health.record().frames == 5);
  CHECK(toy.health.record().incomplete == 1);
  CHECK(toy.judge(7).detail == "data incomplete: a control interval came without mpm/cv");
}

TEST_CASE("the worst trouble gives the state, and what is told elsewhere is one of them") {
  Toy toy(1.0);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  const bus::Trouble disk{"journal", Severity::kMaintenanceRequired, "the disk is full"};
  CHECK(toy.judge(5, {disk}).state == "maintenance_required");
  CHECK(toy.judge(5, {disk}).detail == "the disk is full");
  const bus::Trouble dead{"dead", Severity::kFailure, "it burns"};
  const HealthRecord worst = toy.judge(5, {disk, dead});
  CHECK(worst.state == "failure");
  CHECK(worst.detail == "it burns; the disk is full");
  CHECK(toy.health.troubles().size() == 2);
  CHECK(toy.judge(5, {}, "stands by").detail ==
        "stands by; " + std::string(bus::kNothingDetermined));
}

TEST_CASE("an alarm that is silenced is none to health, which says that there is one") {
  Toy toy(1.0);
  const bus::Trouble disk{"journal", Severity::kMaintenanceRequired, "the disk is full"};
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  toy.monitor.stand(0);
  CHECK(toy.judge(5).state == "maintenance_required");
  CHECK(toy.judge(5).detail == "1 alarm");
  CHECK(toy.judge(5, {disk}).detail == "1 alarm; the disk is full");
  toy.silenced_alarms = 1;
  const HealthRecord silenced = toy.judge(5);
  CHECK(silenced.active_alarms == 1);
  CHECK(silenced.silenced_alarms == 1);
  CHECK(silenced.state == "function_check");
  CHECK(silenced.detail == bus::kNothingDetermined);
  CHECK(toy.judge(5, {disk}).detail == "the disk is full; 1 silenced alarm");
}

TEST_CASE("health says of predictions that are corrected by the measurement who predicts instead") {
  for (const bool corrects : {false, true}) {
    CAPTURE(corrects);
    Toy toy(1.0, "{tag: y, prediction: yp}");
    double model = 0.0, bias = 0.0;
    for (int k = 0; k < 600; ++k) {
      have_come(toy, k);
      const double u = k % 9 - 4.0, y = model + 1.0 + 0.1 * test::uniform(7, k);
      Frame frame(toy.loaded.config.counts());
      for (SignalBlock& block : frame.blocks)
        std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
      frame.interval = k;
      frame.source_time_ns = k * std::int64_t{1'000'000'000};
      frame[SignalKind::kMv].values(0) = u;
      frame[SignalKind::kCv].values(0) = y;
      frame[SignalKind::kPrediction].values(0) = model + bias;
      toy.monitor.push(frame);
      if (corrects) bias += 0.8 * (y - model - bias);
      model += (1.0 - std::exp(-0.2)) * (2.0 * u - model);
    }
    const std::string told =
        "the unit file's model predicts y: the predictions that come are corrected by the "
        "measurement";
    const std::string detail = toy.judge(600).detail;
    CAPTURE(detail);
    CHECK((detail.find(told) != std::string::npos) == corrects);
  }
}

TEST_CASE("health says of predictions of another model that they are none of the unit file's") {
  for (const bool other : {false, true}) {
    CAPTURE(other);
    Toy toy(1.0, "{tag: y, prediction: yp}");
    double model = 0.0;
    for (int k = 0; k < 2600; ++k) {
      have_come(toy, k);
      Frame frame(toy.loaded.config.counts());
      for (SignalBlock& block : frame.blocks)
        std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
      frame.interval = k;
      frame.source_time_ns = k * std::int64_t{1'000'000'000};
      const double u = k % 9 - 4.0;
      frame[SignalKind::kMv].values(0) = u;
      frame[SignalKind::kCv].values(0) = model + 0.1 * test::uniform(7, k);
      frame[SignalKind::kPrediction].values(0) = other ? 1.4 * model : model;
      toy.monitor.push(frame);
      model += (1.0 - std::exp(-0.2)) * (2.0 * u - model);
    }
    const std::string detail = toy.judge(2600).detail;
    CAPTURE(detail);
    CHECK((detail.find("the predictions that come of y are not what the unit file's model gives") !=
           std::string::npos) == other);
  }
}

TEST_CASE("a frame that was not complete is told for two samples") {
  Toy toy(2.0);
  for (int s = 1; s <= 5; s += 2) have_come(toy, s);
  CHECK(toy.judge(5).detail == bus::kNothingDetermined);
  toy.aligner.incomplete = 1;
  toy.aligner.without[static_cast<std::size_t>(SignalKind::kCv)] = 1;
  const std::string told = "data incomplete: a control interval came without mpm/cv";
  CHECK(toy.judge(6).detail == told);
  CHECK(toy.judge(9).detail == told);
  CHECK(toy.judge(10).detail == bus::kNothingDetermined);
}

TEST_CASE("what a process before this one missed is no news") {
  Toy toy(1.0);
  toy.aligner.incomplete = 5;
  toy.health.recall(toy.aligner);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  CHECK(toy.judge(5).detail == bus::kNothingDetermined);
}

TEST_CASE("what a process before this one had, and what was missed in between, is told") {
  Toy toy(1.0);
  toy.aligner.frames = 5;
  toy.health.recall(toy.aligner);
  for (int s = 0; s < 10; ++s) CHECK(toy.judge(s).state == "function_check");
  const HealthRecord silent = toy.judge(10);
  CHECK(silent.state == "failure");
  CHECK(silent.detail.find("no data for 10 s") == 0);
  constexpr std::int64_t kTime = 1'700'000'000'000'000'000;
  for (int s = 11; s < 14; ++s) have_come(toy, s);
  toy.health.missed(401, kTime, kTime + 9'000'000'000);
  CHECK(toy.judge(14).detail ==
        "this monitor was away from 2023-11-14T22:13:20Z to 2023-11-14T22:13:29Z: 401 intervals "
        "are missing");
  CHECK(toy.judge(14).state == "out_of_specification");
  for (int s = 15; s < 75; ++s) have_come(toy, s);
  CHECK(toy.judge(75).detail == bus::kNothingDetermined);
}

TEST_CASE("a signal that is bad stays so while nothing comes, until that is told") {
  Toy toy(1.0);
  int s = 1;
  for (; s < 100; ++s) {
    have_come(toy, s);
    Frame frame(toy.loaded.config.counts());
    for (SignalBlock& block : frame.blocks)
      block.quality.assign(block.quality.size(), Quality::kGood);
    frame.interval = s;
    frame[SignalKind::kMv].values(0) = s % 7;
    frame[SignalKind::kCv].values(0) = std::nan("");
    frame[SignalKind::kCv].quality[0] = Quality::kBad;
    toy.monitor.push(frame);
  }
  CHECK(toy.judge(s).detail.find("y is bad since") == 0);
  for (; s < 109; ++s) {
    CAPTURE(s);
    CHECK(toy.judge(s).detail.find("y is bad since") == 0);
  }
  CHECK(toy.judge(109).state == "failure");
  CHECK(toy.judge(109).detail.find("no data for 10 s") == 0);
}

TEST_CASE("samples of which no frame is made are a failure only while no frame is made of others") {
  Toy toy(1.0, "{tag: y, prediction: yp}");
  const std::vector<double> too_many = {1.0, 2.0};
  const auto predictions = [&](int s) {  // of another length
    idl::SampleView sample;
    sample.kind = SignalKind::kPrediction;
    sample.interval = s;
    sample.source_time_ns = s * std::int64_t{1'000'000'000};
    sample.values = too_many;
    toy.health.push(sample, 0);
  };
  int s = 1;
  for (; s < 30; ++s) {
    have_come(toy, s);
    predictions(s);
    CHECK(toy.judge(s).state == "out_of_specification");
  }
  CHECK(toy.judge(s).detail ==
        "mpm/prediction has 2 values and 0 qualities where the unit file has 1 signal");

  // Two counters: one goes on, or nobody can tell which.
  const auto second_gateway = [&](int at) {
    const std::vector<double> value = {1.0};
    idl::SampleView sample;
    sample.kind = SignalKind::kMv;
    sample.interval = 5000 + at;
    sample.source_time_ns = at * std::int64_t{1'000'000'000};
    sample.values = value;
    sample.writer = 7;
    toy.health.push(sample, 0);
  };
  for (; s < 60; ++s) {
    second_gateway(s);
    have_come(toy, s);
    predictions(s);
    (void)toy.judge(s);
  }
  CHECK(toy.judge(s).detail.find("two gateways write mpm/mv") == 0);
  CHECK(toy.judge(s).state == "out_of_specification");
  for (; s < 75; ++s) {
    second_gateway(s);
    have_come(toy, s);
    predictions(s);
    --toy.aligner.frames;
    (void)toy.judge(s);
  }
  CHECK(toy.judge(s).detail.find("two gateways write mpm/mv") == 0);
  CHECK(toy.judge(s).state == "failure");
}

TEST_CASE("set-points of another length are told though nobody waits for them") {
  for (const bool used : {true, false}) {
    CAPTURE(used);
    Toy toy(1.0, used ? "{tag: y, setpoint: ysp}" : "y");
    const std::vector<double> too_many = {1.0, 2.0};
    for (int s = 1; s < 10; ++s) {
      have_come(toy, s);
      idl::SampleView sample;
      sample.kind = SignalKind::kSetpoint;
      sample.interval = s;
      sample.source_time_ns = s * std::int64_t{1'000'000'000};
      sample.values = too_many;
      toy.health.push(sample, 0);
    }
    const HealthRecord record = toy.judge(10);
    CHECK(record.state == (used ? "out_of_specification" : "function_check"));
    CHECK((record.detail ==
           "mpm/setpoint has 2 values and 0 qualities where the unit file has 1 signal") == used);
  }
}

TEST_CASE("a start that took long is no standstill") {
  Toy toy(1.0);
  CHECK(toy.judge(9).detail == bus::kNoCompleteData);  // nor is anything silent yet
  CHECK(toy.judge(39).detail.find("the monitor itself stood still for 30 s") != std::string::npos);
}

TEST_CASE("a standstill of the monitor itself is told for a minute, and blames nobody else") {
  Toy toy(1.0);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  const HealthRecord after = toy.judge(34);
  CHECK(after.state == "out_of_specification");
  CHECK(after.detail.find("the monitor itself stood still for 30 s") == 0);
  CHECK(toy.health.troubles().size() == 1);
}

}  // namespace mpm::live::unit_health_test
