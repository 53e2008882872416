#include "daemon/live/live_diagnosis.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "config/load_unit.hpp"
#include "core/archive/archive.hpp"
#include "tests/daemon/live/live_frames.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::live::live_diagnosis_test {
namespace {

using namespace std::chrono_literals;

std::shared_ptr<const config::UnitConfig> toy() {
  config::LoadResult loaded = config::load_unit_text(R"(
unit: toy
sample_time: 1.0
signals: {mv: [u1, u2], cv: [y1]}
model:
  channels:
    - {cv: y1, mv: u1, gain: 2, time_constants: [5]}
    - {cv: y1, mv: u2, gain: 1, time_constants: [5]}
monitor: {diagnosis_samples: 1000, diagnosis_period: 0}
)",
                                                     "toy.yaml");
  REQUIRE(loaded.ok());
  return std::make_shared<const config::UnitConfig>(std::move(loaded.config));
}

AlarmRecord change(const std::string& mv, AlarmChange to, std::int64_t k) {
  AlarmRecord record;
  record.unit = "toy";
  record.mv = mv;
  record.cv = "y1";
  record.to = to;
  record.interval = k;
  record.source_time_ns = k * 1'000'000'000;
  return record;
}

constexpr LiveDiagnosis::Clock::time_point kNow{std::chrono::seconds(1000)};

DiagnosisOutcome named() {
  DiagnosisOutcome outcome;
  outcome.headline = "found";
  outcome.causes = {{"gain", "u1 it is.", 0.9, {{"gain_ratio", 0.7, 0.6, 0.8}}},
                    {{}, "Not this channel.", 0.0, {}}};
  return outcome;
}

/// Diagnoses that the test lets through one by one.
class Gate {
 public:
  DiagnosisWorker::Work work() {
    return [this](const DiagnosisJob& job,
                  const DiagnosisWorker::GoOn& go_on) -> std::optional<DiagnosisOutcome> {
      {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(job);
      }
      ++begun;
      while (open == 0 && go_on()) std::this_thread::sleep_for(1ms);
      if (!go_on()) return std::nullopt;
      --open;
      return named();
    };
  }
  DiagnosisJob job(std::size_t i) {
    const std::lock_guard lock(mutex_);
    return jobs_.at(i);
  }

  std::atomic<int> begun = 0, open = 0;

 private:
  std::mutex mutex_;
  std::vector<DiagnosisJob> jobs_;
};

/// Frames from `first` to `last`, with one change at the first.
void feed(LiveDiagnosis& live, std::int64_t first, std::int64_t last,
          const std::vector<AlarmRecord>& changes = {}) {
  for (std::int64_t k = first; k <= last; ++k)
    live.push(test::frame_at(k, {2, 0, 1, 0}), k == first ? changes : std::vector<AlarmRecord>{});
}

std::optional<DiagnosisOutcome> await(LiveDiagnosis& live) {
  std::optional<DiagnosisOutcome> outcome;
  (void)idl::eventually([&] { return (outcome = live.poll(kNow)).has_value(); });
  return outcome;
}

}  // namespace

// As over a restart: the second one has the first one's state, and the unit's alarms.
TEST_CASE("a diagnosis that was due before a restart is made again while its alarm stands") {
  for (const bool stands : {true, false}) {
    CAPTURE(stands);
    Gate first_gate, gate;
    DiagnosisWorker first_worker(first_gate.work()), worker(gate.work());
    LiveDiagnosis first(toy(), first_worker, 0), second(toy(), worker, 0);
    feed(first, 1, 700, {change("u1", AlarmChange::kActive, 1)});
    take_back(put_away(first), second);
    AlarmStateRecord u1(change("u1", AlarmChange::kActive, 1)),
        u2(change("u2", AlarmChange::kCleared, 300));
    second.resume({u1, u2});
    feed(second, 701, 710,
         {change("u1", stands ? AlarmChange::kActive : AlarmChange::kCleared, 701)});
    second.repeat();
    gate.open = 1;
    if (!stands) {
      CHECK_FALSE(second.poll(kNow));
      CHECK(gate.begun == 0);
      continue;
    }
    const auto outcome = await(second);
    REQUIRE(outcome);
    CHECK(outcome->interval == 710);
    CHECK(gate.job(0).samples.rows() == 710);
    CHECK(gate.job(0).alarm_time_ns == 701'000'000'000);
    const std::vector<AlarmRecord> named = second.diagnosed(*outcome);
    REQUIRE(named.size() == 1);
    CHECK(named[0].mv == "u1");
  }
}

TEST_CASE("what was never due is not made after a restart") {
  Gate first_gate, gate;
  DiagnosisWorker first_worker(first_gate.work()), worker(gate.work());
  LiveDiagnosis first(toy(), first_worker, 0), second(toy(), worker, 0);
  feed(first, 1, 20, {change("u1", AlarmChange::kActive, 1)});  // too few samples
  take_back(put_away(first), second);
  second.resume({AlarmStateRecord(change("u1", AlarmChange::kActive, 1))});
  second.repeat();
  CHECK_FALSE(second.poll(kNow));
  CHECK(gate.begun == 0);
  feed(second, 21, 700);
  gate.open = 1;
  CHECK(await(second));
}

TEST_CASE("the samples of an alarm that stands are diagnosed, and its channel gets the cause") {
  Gate gate;
  DiagnosisWorker worker(gate.work());
  LiveDiagnosis live(toy(), worker, 3);
  feed(live, 1, 400);
  CHECK_FALSE(live.poll(kNow));
  feed(live, 401, 700,
       {change("u1", AlarmChange::kActive, 401), change("u2", AlarmChange::kActive, 401)});
  CHECK_FALSE(live.poll(kNow));
  CHECK(gate.begun == 0);
  feed(live, 701, 701);
  CHECK_FALSE(live.poll(kNow));
  gate.open = 1;
  const auto outcome = await(live);
  REQUIRE(outcome);
  CHECK(outcome->asker == 3);
  CHECK(outcome->interval == 701);
  CHECK(outcome->time_ns == 701'000'000'000);
  const DiagnosisJob job = gate.job(0);
  CHECK(job.samples.rows() == 701);
  CHECK(job.unseen_rows == 150);
  CHECK(job.alarm_time_ns == 401'000'000'000);

  const std::vector<AlarmRecord> records = live.diagnosed(*outcome);
  REQUIRE(records.size() == 2);
  CHECK(records[0].mv == "u1");
  CHECK(records[0].to == AlarmChange::kDiagnosed);
  CHECK(records[0].interval == 401);
  CHECK(records[0].named.cause == "gain");
  REQUIRE(records[0].named.parameters.size() == 1);
  CHECK(records[0].named.parameters[0].value == 0.7);
  CHECK_FALSE(records[1].named.cause);
  CHECK(records[1].named.text == "Not this channel.");
  CHECK_FALSE(live.poll(kNow));  // once
}

TEST_CASE("a diagnosis says nothing of alarms that cleared, nor of those raised after it") {
  Gate gate;
  DiagnosisWorker worker(gate.work());
  LiveDiagnosis live(toy(), worker, 0);
  feed(live, 1, 400, {change("u1", AlarmChange::kActive, 1)});
  gate.open = 1;
  const auto outcome = await(live);
  REQUIRE(outcome);
  feed(live, 401, 401,
       {change("u2", AlarmChange::kActive, 401), change("u1", AlarmChange::kCleared, 401)});
  CHECK(live.diagnosed(*outcome).empty());
}

TEST_CASE("a report that could not be written is written once it can be") {
  std::atomic<bool> full = true;
  std::atomic<int> wrote = 0;
  const auto run = std::make_shared<const report::DiagnosisRun>();
  DiagnosisWorker worker([&](const DiagnosisJob& job, const DiagnosisWorker::GoOn&) {
    DiagnosisOutcome outcome = job.only_writes ? DiagnosisOutcome{} : named();
    if (job.only_writes) {
      CHECK(job.unwritten == run);
      CHECK(job.alarm_time_ns == 1'000'000'000);
    } else {
      outcome.unwritten = run;
    }
    outcome.file_problem = full ? "No space left on device" : "";
    ++wrote;
    return std::optional(outcome);
  });
  LiveDiagnosis live(toy(), worker, 0);
  feed(live, 1, 400, {change("u1", AlarmChange::kActive, 1)});
  const auto told = await(live);
  REQUIRE(told);
  CHECK_FALSE(told->only_wrote);
  CHECK(live.file_problem() == "No space left on device");
  CHECK_FALSE(live.poll(kNow + 59s));
  CHECK(wrote == 1);

  const auto again = [&](std::chrono::seconds after) {
    std::optional<DiagnosisOutcome> outcome;
    REQUIRE(idl::eventually([&] { return (outcome = live.poll(kNow + after)).has_value(); }));
    CHECK(outcome->only_wrote);
  };
  again(61s);
  CHECK(live.file_problem() == "No space left on device");
  full = false;
  again(122s);
  CHECK(live.file_problem().empty());
  CHECK_FALSE(live.poll(kNow + 1000s));
  CHECK(wrote == 3);
}

TEST_CASE("of each unit one job waits, the youngest, and no unit waits for another's second") {
  Gate gate;
  DiagnosisWorker worker(gate.work());
  DiagnosisJob job;
  const auto submit = [&](int asker, std::int64_t interval) {
    job = {};
    job.asker = asker;
    job.samples.last_interval = interval;
    CHECK(idl::eventually([&] { return worker.submit(job); }));
  };
  submit(0, 1);
  REQUIRE(idl::eventually([&] { return gate.begun == 1; }));
  submit(0, 2);
  submit(1, 3);
  submit(0, 4);  // instead of 2
  gate.open = 3;
  REQUIRE(idl::eventually([&] { return gate.begun == 3 && gate.open == 0; }));
  CHECK(gate.job(1).samples.last_interval == 4);
  CHECK(gate.job(2).samples.last_interval == 3);
  std::optional<DiagnosisOutcome> outcome;
  CHECK(idl::eventually([&] { return (outcome = worker.take(1)).has_value(); }));
  CHECK(outcome->interval == 3);
  CHECK(idl::eventually([&] { return (outcome = worker.take(0)).has_value(); }));
  CHECK(outcome->interval == 4);  // the first one's outcome is out of date
  CHECK_FALSE(worker.take(0));
}

TEST_CASE("what goes wrong in a diagnosis is told") {
  DiagnosisWorker worker(
      [](const DiagnosisJob&, const DiagnosisWorker::GoOn&) -> std::optional<DiagnosisOutcome> {
        throw std::runtime_error("no way");
      });
  DiagnosisJob job;
  REQUIRE(idl::eventually([&] { return worker.submit(job); }));
  std::optional<DiagnosisOutcome> outcome;
  CHECK(idl::eventually([&] { return (outcome = worker.take(0)).has_value(); }));
  CHECK(outcome->problem == "no way");
}

TEST_CASE("a worker stops at once, in the middle of a diagnosis or idle, or is left to itself") {
  Gate gate;
  DiagnosisJob job;
  SECTION("in the middle") {
    DiagnosisWorker worker(gate.work());
    REQUIRE(idl::eventually([&] { return worker.submit(job); }));
    REQUIRE(idl::eventually([&] { return gate.begun == 1; }));
    CHECK(worker.stop(5s));
    CHECK_FALSE(worker.take(0));
  }
  SECTION("idle, twice") {
    DiagnosisWorker worker(gate.work());
    CHECK(worker.stop(5s));
    CHECK(worker.stop(5s));
  }
  SECTION("by its destructor") { const DiagnosisWorker worker(gate.work()); }
  SECTION("deaf") {
    auto through = std::make_shared<std::atomic<bool>>(false);  // outlives the worker
    auto begun = std::make_shared<std::atomic<bool>>(false);
    DiagnosisWorker worker(
        [=](const DiagnosisJob&, const DiagnosisWorker::GoOn&) -> std::optional<DiagnosisOutcome> {
          *begun = true;
          while (!*through) std::this_thread::sleep_for(1ms);
          return std::nullopt;
        });
    REQUIRE(idl::eventually([&] { return worker.submit(job); }));
    REQUIRE(idl::eventually([&] { return begun->load(); }));
    CHECK_FALSE(worker.stop(20ms));
    *through = true;
  }
}

}  // namespace mpm::live::live_diagnosis_test
