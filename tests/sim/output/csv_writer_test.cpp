#include <catch2/catch.hpp>
#include <cstdlib>
#include <sstream>
#include <string>

#include "sim/output/csv_writer.hpp"
#include "sim/output/truth.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/sim/units.hpp"

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
