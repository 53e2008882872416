#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "daemon/report/diagnosis/clock_text.hpp"
#include "daemon/report/page/model_views.hpp"
#include "daemon/report/page/plot_json.hpp"
#include "daemon/report/page/residual_views.hpp"
#include "daemon/report/page/telling_window.hpp"
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
  const std::size_t every = thinning(values.size(), 400);
  const Envelope thin = envelope_of(values, every);
  CHECK(thin.low.size() <= 400);
  CHECK(*std::max_element(thin.high.begin(), thin.high.end()) == 8.0);
  CHECK(*std::min_element(thin.low.begin(), thin.low.end()) == -8.0);
  CHECK(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(0) == 2.0);
  CHECK(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(1) == 5.0);
  CHECK(std::isnan(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(2)));
  CHECK(means_of(values, 1) == values);
}

TEST_CASE("digits that cannot be seen are not written") {
  CHECK(visible_digits({0.123456, 10.0, kNaN, -1e-9}).dump() == "[0.12,10.0,null,0.0]");
  CHECK(visible_digits({123456.0, 123456.0}).dump() == "[123456.0,123456.0]");
}

TEST_CASE("the telling window lies inside a run, beside those that were shown") {
  std::vector<double> weights(100, 0.0);
  weights[30] = weights[70] = 5.0;
  weights[72] = kNaN;
  weights[75] = 1.0;
  const std::vector<Run> one = {{0, 100}};
  const Run best = telling_window(weights, one, 10, {});
  CHECK(best.count == 10);
  CHECK(best.first == 66);  // the first that holds 70 and 75
  const Run second = telling_window(weights, one, 10, {best});
  CHECK(second.first == 21);
  const Run cut = telling_window(weights, {{0, 72}, {72, 28}}, 10, {});
  CHECK(cut.first + cut.count <= 72);
  CHECK(telling_window(weights, one, 60, {{20, 60}}).count == 0);
  CHECK(window_around(40, one, 20).first == 35);
  CHECK(window_around(2, one, 20).first == 0);
  CHECK(window_around(99, one, 20).first == 80);
}

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

TEST_CASE("moments read as people write them") {
  CHECK(clock_text(812.0) == "812 s");
  CHECK(clock_text(1767225661.5) == "2026-01-01 00:01:01 UTC");
}

}  // namespace
}  // namespace mpm::test
