#include "daemon/report/identification/plan_report.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/report/identification/small_run.hpp"

namespace mpm::test {

TEST_CASE("a plan says input, size, levels and length") {
  report::IdentificationRun run = small_run();
  run.plan = std::vector<PlannedTest>{{1, {0}, TestSignal::kBinary, 0.5, 20.0, 600.0, 60.0},
                                      {0, {0}, TestSignal::kSteps, {}, 60.0, 240.0, 60.0}};
  const std::string text = report::plan_text(run);
  CHECK(text.find("v (for y): by +-0.5, two levels at random, 20 s each on average, for 10 min") !=
        std::string::npos);
  CHECK(text.find("give it limits under `simulation`") != std::string::npos);
  CHECK(text.find("one after the other: 14 min") != std::string::npos);
  const nlohmann::ordered_json json = report::plan_json(run);
  CHECK(json[0]["amplitude"] == 0.5);
  CHECK(json[1]["amplitude"].is_null());
  run.plan->clear();
  CHECK(report::plan_text(run).find("every MV has moved enough") != std::string::npos);
}

TEST_CASE("limits are those of the section `simulation`") {
  config::UnitConfig unit = small_run().unit;
  unit.simulation.mv_limits[1].low = -1.0;
  unit.simulation.cv_limits[0].high = 4.0;
  const TestLimits limits = report::test_limits(unit);
  CHECK(limits.inputs[1].low == -1.0);
  CHECK(limits.cvs[0].high == 4.0);
}

}  // namespace mpm::test
