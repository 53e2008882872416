#include "sim/output/bad_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "sim/output/csv_writer.hpp"
#include "sim/output/truth.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/sim/units.hpp"

namespace {

using mpm::Frame;
using mpm::Quality;
using mpm::SignalKind;
using mpm::config::BadData;
using mpm::config::BadDataKind;
using mpm::sim::BadDataFilter;
using mpm::sim::ClosedLoop;
using mpm::sim::LoopSetup;

LoopSetup setup_with(BadDataKind kind, double share, const std::vector<std::string>& tags) {
  LoopSetup setup = mpm::test::healthy_loop(mpm::test::load_plant("shell3x3"));
  setup.samples = 10000;
  BadData bad;
  bad.kind = kind;
  bad.share = share;
  bad.tags = tags;
  setup.scenario.bad_data = {bad};
  return setup;
}

/// Runs the loop; `see(true frame, reported frame or null, time error)` for every interval.
template <class See>
void run(const LoopSetup& setup, BadDataFilter& filter, See see) {
  ClosedLoop loop(setup);
  for (std::int64_t k = 0; k < *setup.samples; ++k) {
    const Frame& frame = loop.step();
    const Frame* reported = filter.apply(frame);
    see(frame, reported, filter.time_error_s());
  }
}

double cv(const Frame& frame, int index) { return frame[SignalKind::kCv].values(index); }

}  // namespace

TEST_CASE("missing and uncertain values come in their share, each tag for itself") {
  const BadDataKind kind = GENERATE(BadDataKind::kMissing, BadDataKind::kUncertain);
  const LoopSetup setup = setup_with(kind, 0.05, {"y2", "u1"});
  BadDataFilter filter(setup);
  int missing[2] = {}, both = 0;
  run(setup, filter, [&](const Frame& frame, const Frame* reported, double) {
    REQUIRE(reported != nullptr);
    const Quality expected = kind == BadDataKind::kMissing ? Quality::kBad : Quality::kUncertain;
    const bool y2 = (*reported)[SignalKind::kCv].quality[1] == expected;
    const bool u1 = (*reported)[SignalKind::kMv].quality[0] == expected;
    CHECK(std::isnan(cv(*reported, 1)) == (y2 && kind == BadDataKind::kMissing));
    if (kind == BadDataKind::kUncertain) CHECK(cv(*reported, 1) == cv(frame, 1));
    CHECK(cv(*reported, 0) == cv(frame, 0));
    CHECK((*reported)[SignalKind::kCv].quality[0] == Quality::kGood);
    missing[0] += y2;
    missing[1] += u1;
    both += y2 && u1;
  });
  // Binomial: sd sqrt(10000 .05 .95) = 22 around 500, and 5 around 25.
  CHECK(std::abs(missing[0] - 500) < 88);
  CHECK(std::abs(missing[1] - 500) < 88);
  CHECK(std::abs(both - 25) < 20);
  CHECK(filter.counts()[0].samples == missing[0] + missing[1]);
  CHECK(filter.counts()[0].possible == 20000);
}

TEST_CASE("gaps leave whole rows out, in runs") {
  LoopSetup setup = setup_with(BadDataKind::kGaps, 0.05, {});
  setup.scenario.bad_data[0].run_samples = 10;
  BadDataFilter filter(setup);
  int rows = 0, runs = 0;
  bool before = true;
  run(setup, filter, [&](const Frame&, const Frame* reported, double) {
    if (reported == nullptr) ++rows;
    if (reported == nullptr && before) ++runs;
    before = reported != nullptr;
  });
  CHECK(rows == 500);  // one run of 10 in every 200 samples
  CHECK(runs <= 50);   // two may touch
  CHECK(runs > 45);
}

TEST_CASE("frozen values repeat with good quality") {
  LoopSetup setup = setup_with(BadDataKind::kFrozen, 0.2, {"y1", "y2"});
  setup.scenario.bad_data[0].run_samples = 40;
  BadDataFilter filter(setup);
  double last = 0.0;
  int repeats = 0, other = 0;
  run(setup, filter, [&](const Frame& frame, const Frame* reported, double) {
    const double value = cv(*reported, 0);
    CHECK((*reported)[SignalKind::kCv].quality[0] == Quality::kGood);
    if (frame.interval > 0 && value == last) {
      ++repeats;
    } else {
      REQUIRE(value == cv(frame, 0));
    }
    if (cv(*reported, 1) != cv(frame, 1)) ++other;
    last = value;
  });
  CHECK(std::abs(repeats - 2000) <= 1);  // a run that begins with the first sample has one less
  CHECK(std::abs(other - 2000) <= 1);
}

TEST_CASE("spikes have their size, either way") {
  LoopSetup setup = setup_with(BadDataKind::kSpikes, 0.01, {"y3"});
  setup.scenario.bad_data[0].sizes = {2.5};
  BadDataFilter filter(setup);
  int up = 0, down = 0;
  run(setup, filter, [&](const Frame& frame, const Frame* reported, double) {
    const double error = cv(*reported, 2) - cv(frame, 2);
    if (error == 0.0) return;
    CHECK(std::abs(error) == Approx(2.5));
    ++(error > 0.0 ? up : down);
  });
  CHECK(std::abs(up + down - 100) < 40);  // binomial, sd 10
  CHECK(std::abs(up - down) < 40);
}

TEST_CASE("clipping keeps values within a range") {
  LoopSetup setup = setup_with(BadDataKind::kClipping, 0.0, {"y1"});
  SECTION("given") {
    setup.scenario.bad_data[0].high = 0.3;
    BadDataFilter filter(setup);
    run(setup, filter, [&](const Frame& frame, const Frame* reported, double) {
      REQUIRE(cv(*reported, 0) == std::min(0.3, cv(frame, 0)));
    });
  }
  SECTION("that a share of the values lie beyond") {
    setup.scenario.bad_data[0].share = 0.1;
    BadDataFilter filter(setup);
    int clipped = 0;
    run(setup, filter, [&](const Frame& frame, const Frame* reported, double) {
      clipped += cv(*reported, 0) != cv(frame, 0);
    });
    CHECK(std::abs(clipped - 1000) <= 2);
    CHECK(filter.details()[0].low[0] < -0.3);
    CHECK(filter.details()[0].high[0] > 0.3);
  }
}

TEST_CASE("time stamps jitter and the clock jumps, the data do not") {
  LoopSetup setup = setup_with(BadDataKind::kTimeJitter, 0.2, {});
  BadData steps;
  steps.kind = BadDataKind::kClockSteps;
  steps.steps_s = {30.0, -10.0};
  setup.scenario.bad_data.push_back(steps);
  BadDataFilter filter(setup);
  const std::vector<double> times = filter.details()[1].step_times_s;
  REQUIRE(times.size() == 2);
  REQUIRE(times[0] < times[1]);
  double squares = 0.0;
  run(setup, filter, [&](const Frame& frame, const Frame* reported, double error_s) {
    const auto now = static_cast<double>(frame.interval);
    const double clock = now < times[0] ? 0.0 : now < times[1] ? 30.0 : 20.0;
    CHECK(std::abs(error_s - clock) <= 0.2 + 1e-6);
    CHECK(reported->source_time_ns - frame.source_time_ns == std::llround(error_s * 1e9));
    CHECK(reported->interval == frame.interval);
    CHECK((*reported)[SignalKind::kCv].values == frame[SignalKind::kCv].values);
    squares += (error_s - clock) * (error_s - clock);
  });
  CHECK(squares / 10000 == Approx(0.04 / 3.0).epsilon(0.05));  // even between -0.2 and 0.2
  setup.samples.reset();
  CHECK_THROWS_WITH(BadDataFilter(setup), Catch::Matchers::Contains("--samples"));
}

TEST_CASE("bad data have their time, do not reach the loop and do not shift each other") {
  LoopSetup setup = setup_with(BadDataKind::kMissing, 0.3, {"y1"});
  setup.scenario.bad_data[0].from_s = 1000.0;
  setup.scenario.bad_data[0].until_s = 2000.0;
  LoopSetup more = setup;
  BadData spikes;
  spikes.kind = BadDataKind::kSpikes;
  spikes.share = 0.5;
  spikes.tags = {"y2"};
  spikes.sizes = {1.0};
  more.scenario.bad_data.insert(more.scenario.bad_data.begin(), spikes);
  BadDataFilter filter(setup), other(more);
  ClosedLoop loop(setup), plain(mpm::test::healthy_loop(setup.unit));
  for (int k = 0; k < 3000; ++k) {
    const Frame& frame = loop.step();
    REQUIRE(frame[SignalKind::kCv].values == plain.step()[SignalKind::kCv].values);
    const bool missing = std::isnan(cv(*filter.apply(frame), 0));
    if (missing) CHECK((k >= 1000 && k < 2000));
    CHECK(missing == std::isnan(cv(*other.apply(frame), 0)));
  }
  CHECK(std::abs(filter.counts()[0].samples - 300) < 60);  // sd 14
}

TEST_CASE("the data file has empty cells and quality columns, the truth what was done") {
  LoopSetup setup = setup_with(BadDataKind::kUncertain, 1.0, {"y2"});
  BadData missing;
  missing.tags = {"y1"};
  missing.share = 1.0;
  setup.scenario.bad_data.push_back(missing);
  setup.samples = 2;
  BadDataFilter filter(setup);
  std::ostringstream out;
  mpm::sim::CsvWriter csv(out, setup.unit, 0.0, mpm::sim::uncertain_tags(setup.scenario));
  Frame frame(setup.unit.counts());
  frame[SignalKind::kCv].values << 1.0, 2.0, 3.0;
  for (Quality& quality : frame[SignalKind::kCv].quality) quality = Quality::kGood;
  csv.write(*filter.apply(frame), 0.25);
  CHECK(out.str() ==
        "time,sp1,sp2,sp3,u1,u2,u3,y1,y2,y2.quality,y3,yhat1,yhat2,yhat3\n"
        "0.25,0,0,0,0,0,0,,2,uncertain,3,0,0,0\n");
  const std::string truth = mpm::sim::truth_json(setup, "", &filter);
  for (const char* part : {R"("kind": "uncertain")", R"("kind": "missing")", R"("touched": 1)"})
    CHECK(truth.find(part) != std::string::npos);
}

TEST_CASE("spoiling a frame does not allocate") {
  LoopSetup setup = setup_with(BadDataKind::kMissing, 0.1, {"y1", "u1"});
  for (const BadDataKind kind :
       {BadDataKind::kUncertain, BadDataKind::kFrozen, BadDataKind::kSpikes, BadDataKind::kGaps,
        BadDataKind::kClipping, BadDataKind::kTimeJitter}) {
    setup.scenario.bad_data.push_back(setup.scenario.bad_data[0]);
    setup.scenario.bad_data.back().kind = kind;
  }
  setup.samples = 500;
  BadDataFilter filter(setup);
  ClosedLoop loop(setup);
  const std::uint64_t before = mpm::test::allocation_count();
  for (int k = 0; k < 500; ++k) static_cast<void>(filter.apply(loop.step()));
  CHECK(mpm::test::allocation_count() == before);
}
