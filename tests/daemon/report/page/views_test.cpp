#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "daemon/report/diagnosis/clock_text.hpp"
#include "daemon/report/page/model_views.hpp"
#include "daemon/report/page/residual_views.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

TEST_CASE("blocks and levels know what is unknown") {
  CHECK(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(0) == 3.0);
  CHECK(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(1) == 4.0);
  CHECK(std::isnan(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(2)));

  // A level that rests is one part, whatever the number of parts asked for.
  const LevelBins bins = level_bins({1.0, 1.0, 1.0, 1.0, 2.0, kNaN, 3.0, 3.0}, 4);
  REQUIRE(bins.level.size() == 3);
  CHECK(bins.level == std::vector<double>{1.0, 2.0, 3.0});
  const LevelView view = over_levels(bins, {1.0, -1.0, 1.0, -1.0, 5.0, 9.0, kNaN, 2.0});
  CHECK(view.rms == std::vector<double>{1.0, 5.0, 2.0});
  CHECK(view.mean == std::vector<double>{0.0, 5.0, 2.0});
}

TEST_CASE("a thinned series keeps its spikes and stays within its points") {
  std::vector<double> values(100'000, 0.0);
  values[50'123] = 8.0;
  values[50'124] = -8.0;
  const std::size_t every = thinning(values.size(), 4'000);
  const std::vector<double> thin = thinned(values, every);
  CHECK(thin.size() <= 4'000);
  CHECK(*std::max_element(thin.begin(), thin.end()) == 8.0);
  CHECK(*std::min_element(thin.begin(), thin.end()) == -8.0);
  CHECK(thinned(values, 1) == values);
}

TEST_CASE("step responses are of the models as they are, with a band around the refitted channel") {
  const DiagnosisRun run = sample_run();
  const std::vector<StepView> views = step_views(run, 2);
  REQUIRE(views.size() == 3);
  CHECK(views[2].before.back() == Approx(7.20).epsilon(0.01));
  CHECK(views[2].after.back() == Approx(1.4 * 7.20).epsilon(0.01));
  CHECK(views[2].low.back() == Approx(1.37 * 7.20).epsilon(0.01));
  CHECK(views[2].high.back() == Approx(1.43 * 7.20).epsilon(0.01));
  // The input that is new has no channel before.
  const std::vector<StepView> first = step_views(run, 0);
  REQUIRE(first.size() == 4);
  CHECK(first[3].before == std::vector<double>(first[3].before.size(), 0.0));
  CHECK(first[3].after.back() == Approx(1.5).epsilon(0.01));
  CHECK(first[3].low.empty());
}

TEST_CASE("curves are drawn of what differs") {
  DiagnosisRun run = sample_run();
  CHECK(curve_views(run).empty());
  run.diagnosis.extended.input_blocks[0] = Deadband{0.1};
  run.diagnosis.extended.output_blocks[2] = Saturation{-1.0, 1.0};
  const std::vector<CurveView> curves = curve_views(run);
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].x.front() == curves[0].x.back());  // up and down again
  CHECK(curves[0].before == curves[0].x);
  const auto middle = curves[0].x.size() / 4;
  CHECK(std::abs(curves[0].after[middle] - curves[0].x[middle]) == Approx(0.05));
  CHECK(curves[1].after.back() == 1.0);
  CHECK(curves[1].before.back() > 1.0);
}

TEST_CASE("moments read as people write them") {
  CHECK(clock_text(812.0) == "812 s");
  CHECK(clock_text(1767225661.5) == "2026-01-01 00:01:01 UTC");
}

}  // namespace
}  // namespace mpm::test
