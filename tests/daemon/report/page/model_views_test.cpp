#include "daemon/report/page/model_views.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test {
namespace {

using namespace mpm::report;

TEST_CASE("step responses are of the models as they are, in a band that holds the extended one's") {
  const DiagnosisRun run = sample_run();
  const std::vector<ChannelNumbers> channels = channel_numbers(run);
  const auto view = [&](int cv, int input) {
    const auto at = std::find_if(channels.begin(), channels.end(), [&](const ChannelNumbers& each) {
      return each.cv == cv && each.input == input;
    });
    REQUIRE(at != channels.end());
    return step_view(run, *at);
  };
  const StepView gain = view(2, 2);
  CHECK(gain.before.back() == Approx(7.20).epsilon(0.01));
  CHECK(gain.after.back() == Approx(1.4 * 7.20).epsilon(0.01));
  CHECK(gain.low.back() == Approx(1.381 * 7.20).epsilon(0.01));
  CHECK(gain.high.back() == Approx(1.424 * 7.20).epsilon(0.01));
  for (std::size_t i = 0; i < gain.after.size(); ++i) {
    CHECK(gain.low[i] <= gain.after[i]);
    CHECK(gain.after[i] <= gain.high[i]);
  }
  // The input that is new has no channel before.
  const StepView fresh = view(0, 3);
  CHECK(fresh.before == std::vector<double>(fresh.before.size(), 0.0));
  CHECK(fresh.after.back() == Approx(1.5).epsilon(0.01));
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

}  // namespace
}  // namespace mpm::test
