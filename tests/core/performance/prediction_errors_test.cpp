#include "core/performance/prediction_errors.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/core/performance/made_unit.hpp"

namespace mpm {
namespace {

using test::sine;

/// Of two CVs, the second unknown, over horizons of 1, 5 and 10 samples.
struct Sums {
  PredictionErrors errors{2, {1, 5, 10}};
  std::array<PredictionSums, 6> sums;

  void push(std::int64_t interval, double measured, double residual) {
    const std::array<CvReading, 2> readings = {CvReading{measured, residual}, CvReading{}};
    errors.push(interval, readings, [this](std::size_t cv, std::size_t h) -> PredictionSums& {
      return sums[3 * cv + h];
    });
  }
};

// A sine of amplitude a and period p less itself h samples ago is one of amplitude
// 2 a |sin(pi h / p)|, whose rms over whole periods is that over the root of 2.
TEST_CASE("a sine's prediction errors are those of the closed form at every horizon") {
  Sums made;
  for (int k = 0; k < 410; ++k) made.push(k, 3.0 + 2.0 * sine(k, 40.0), 0.5 * sine(k, 25.0));
  const auto rms = [](double amplitude, double samples, double period) {
    return std::sqrt(2.0) * amplitude * std::abs(std::sin(std::numbers::pi * samples / period));
  };
  // 400 pairs are ten periods of 40 and sixteen of 25.
  CHECK(made.sums[2].pairs == 400);
  CHECK(made.sums[2].rmse() == Approx(rms(0.5, 10, 25)).epsilon(1e-12));
  CHECK(made.sums[2].movement_rms() == Approx(rms(2.0, 10, 40)).epsilon(1e-12));
  CHECK(made.sums[1].rmse() == Approx(rms(0.5, 5, 25)).epsilon(0.02));
  CHECK(made.sums[0].pairs == 409);
  CHECK(made.sums[3].pairs == 0);  // of the other CV nothing is known
  CHECK(std::isnan(made.sums[3].rmse()));
}

TEST_CASE("a value that is not known makes no pair, nor does one before a gap meet a wrong one") {
  Sums made;
  // e(k) = k: every pair differs by its horizon exactly.
  for (int k = 0; k < 100; ++k)
    if (k < 40 || k >= 47) made.push(k, k, k == 20 ? test::kUnknown : k);
  for (const auto& [h, samples] : {std::pair{0, 1.0}, {1, 5.0}, {2, 10.0}}) {
    CHECK(made.sums[static_cast<std::size_t>(h)].rmse() == samples);
    CHECK(made.sums[static_cast<std::size_t>(h)].movement_rms() == samples);
  }
  // 99 possible pairs; without 20 two fewer, without 40..46 eight fewer.
  CHECK(made.sums[0].pairs == 99 - 2 - 8);
  made.errors.forget();
  made.push(3, 0.0, 0.0);  // another run, which counts from anywhere
  CHECK(made.sums[0].pairs == 89);
}

}  // namespace
}  // namespace mpm
