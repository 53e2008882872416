#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "daemon/report/diagnosis/clock_text.hpp"
#include "daemon/report/page/lag_correlation.hpp"
#include "daemon/report/page/model_views.hpp"
#include "daemon/report/page/residual_views.hpp"
#include "daemon/report/page/spectrum.hpp"
#include "tests/diagnose/sample_run.hpp"

namespace mpm::test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

std::vector<double> white(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> values(count);
  for (double& value : values) {  // near enough to a normal with variance 1
    value = -6.0;
    for (int i = 0; i < 12; ++i) value += static_cast<double>(random()) / 4294967296.0;
  }
  return values;
}

TEST_CASE("the spectrum of white noise is flat at twice variance times sample time") {
  const double sample_time = 5.0;
  const Spectrum spectrum = welch(white(20'000, 3), sample_time);
  REQUIRE(spectrum.frequency.size() > 10);
  CHECK(spectrum.frequency.back() < 0.5 / sample_time + 1e-12);
  for (std::size_t i = 4; i < spectrum.density.size(); ++i)
    CHECK(spectrum.density[i] == Approx(2.0 * sample_time).epsilon(0.35));
}

TEST_CASE("a sine stands at its own frequency, and gaps do not hide it") {
  std::vector<double> values(4096);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = 7.0 + std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / 16.0);
  for (std::size_t k = 100; k < 130; ++k) values[k] = kNaN;
  const Spectrum spectrum = welch(values, 1.0);
  const auto peak = std::max_element(spectrum.density.begin(), spectrum.density.end());
  const auto at = static_cast<std::size_t>(peak - spectrum.density.begin());
  CHECK(spectrum.frequency[at] == Approx(1.0 / 16.0).epsilon(0.1));
}

TEST_CASE("no spectrum comes of too few or unknown values") {
  CHECK(welch({}, 1.0).frequency.empty());
  CHECK(welch(std::vector<double>(31, 1.0), 1.0).frequency.empty());
  CHECK(welch(std::vector<double>(500, kNaN), 1.0).frequency.empty());
}

TEST_CASE("the lag correlation shows when a residual follows an input, and only then") {
  const std::vector<double> shocks = white(6'000, 5), noise = white(6'000, 6);
  std::vector<double> input(shocks.size()), residual(shocks.size());
  for (std::size_t k = 1; k < input.size(); ++k) input[k] = 0.9 * input[k - 1] + shocks[k];
  for (std::size_t k = 0; k < input.size(); ++k)
    residual[k] = noise[k] + (k >= 4 ? 0.5 * input[k - 4] : 0.0);
  residual[2'000] = kNaN;
  const LagCorrelation result = lag_correlation(input, residual, -10, 20);
  REQUIRE(result.values.size() == 31);
  CHECK(result.bound == Approx(2.0 / std::sqrt(6'000.0)).epsilon(0.02));
  int beyond = 0;
  for (int lag = -10; lag <= 20; ++lag) {
    const double value = result.values[static_cast<std::size_t>(lag + 10)];
    if (lag == 4)
      CHECK(value > 8.0 * result.bound);
    else
      beyond += std::abs(value) > result.bound ? 1 : 0;
  }
  CHECK(beyond <= 5);
  CHECK(lag_correlation(std::vector<double>(500, 2.0), noise, 0, 5).values.empty());
}

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
