#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>
#include <string>

#include "sim/output/csv_writer.hpp"
#include "sim/output/start_time.hpp"
#include "sim/output/truth.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

using mpm::sim::parse_start_time;

TEST_CASE("the data file has the columns of the unit file in order") {
  mpm::config::UnitConfig unit = mpm::test::load_plant("wood_berry");
  unit.cv[1].prediction.clear();
  unit.cv[0].setpoint.clear();
  std::ostringstream out;
  mpm::sim::CsvWriter csv(out, unit, 1000.0);
  mpm::Frame frame(unit.counts());
  frame.interval = 3;
  frame[mpm::SignalKind::kMv].values << 1.0, 0.1;
  frame[mpm::SignalKind::kDv].values << -2e-300;
  frame[mpm::SignalKind::kCv].values << 1.0 / 3.0, 4.0;
  frame[mpm::SignalKind::kPrediction].values << 7.0, 8.0;
  frame[mpm::SignalKind::kSetpoint].values << 5.0, 6.0;
  csv.write(frame);
  CHECK(out.str() ==
        "time,xb_sp,reflux,steam,feed,xd,xb,xd_pred\n"
        "1180,6,1,0.1,-2e-300,0.3333333333333333,4,7\n");
}

TEST_CASE("start times are seconds or ISO 8601") {
  CHECK(parse_start_time("0") == 0);
  CHECK(parse_start_time("1.5") == 1500000000);
  // date -u -d 2024-03-01T12:00:00Z +%s = 1709294400
  CHECK(parse_start_time("2024-03-01T12:00:00Z") == 1709294400000000000);
  CHECK(parse_start_time("2024-03-01T13:00:00.25+01:00") == 1709294400250000000);
  CHECK(parse_start_time("2024-03-01 06:30-0530") == 1709294400000000000);
  for (const char* bad :
       {"", "soon", "2024-03-01T12:00:00", "2024-13-01T12:00:00Z", "2023-02-29T12:00:00Z",
        "2024-03-01T25:00:00Z", "1e30", "nan", "2024-03-01T12:00:00Zx"})
    CHECK_FALSE(parse_start_time(bad).has_value());
}

TEST_CASE("the truth names what is hidden") {
  mpm::sim::LoopSetup setup = mpm::test::healthy_loop(mpm::test::load_plant("shell3x3"), 9);
  setup.scenario.name = "test";
  setup.scenario.changes = {mpm::test::gain_change("y2", "u3", 0.6, 50.0)};
  mpm::sim::hide_changes(setup);
  const std::string truth = mpm::sim::truth_json(setup, "");
  for (const char* part :
       {R"("scenario": "test")", R"("seed": 9)", R"("cv": "y2")", R"("mv": "u3")",
        R"("gain_ratio": 0.6)", R"("from": 50.0)", R"("model": 20.8)", R"("plant": 48.8)"})
    CHECK(truth.find(part) != std::string::npos);
}
