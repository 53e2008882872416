#include "daemon/live/unit_health.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"

namespace mpm::live {
namespace {

using bus::Severity;
using std::chrono::seconds;

const UnitHealth::Clock::time_point kStart{seconds(1000)};

struct Toy {
  explicit Toy(double sample_time_s)
      : loaded(config::load_unit_text("unit: toy\nsample_time: " + std::to_string(sample_time_s) +
                                          "\nsignals: {mv: [u], cv: [y]}\n"
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
    return health.judge({aligner, monitor, 3, around, std::move(others), front}, 1'700'000'000 + s);
  }

  config::LoadResult loaded;
  report::UnitMonitor monitor;
  AlignerCounters aligner;
  bus::Surroundings around;
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
    toy.health.push(sample);
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

TEST_CASE("a frame that was not complete is told for two samples") {
  Toy toy(2.0);
  for (int s = 1; s <= 5; s += 2) have_come(toy, s);
  CHECK(toy.judge(5).detail == bus::kNothingDetermined);
  toy.aligner.incomplete = 1;
  CHECK(toy.judge(6).detail == "data incomplete");
  CHECK(toy.judge(9).detail == "data incomplete");
  CHECK(toy.judge(10).detail == bus::kNothingDetermined);
}

TEST_CASE("what a process before this one missed is no news") {
  Toy toy(1.0);
  toy.aligner.incomplete = 5;
  toy.health.recall(toy.aligner);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  CHECK(toy.judge(5).detail == bus::kNothingDetermined);
}

TEST_CASE("a standstill of the monitor itself is told for a minute, and blames nobody else") {
  Toy toy(1.0);
  for (int s = 1; s < 5; ++s) have_come(toy, s);
  const HealthRecord after = toy.judge(34);
  CHECK(after.state == "out_of_specification");
  CHECK(after.detail.find("the monitor itself stood still for 30 s") == 0);
  CHECK(toy.health.troubles().size() == 1);
}

}  // namespace mpm::live
