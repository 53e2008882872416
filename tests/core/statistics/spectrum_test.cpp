#include "core/statistics/spectrum.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/core/white_noise.hpp"

namespace mpm::spectrum_test {
namespace {

const double kNaN = std::nan("");

TEST_CASE("the spectrum of white noise is flat at twice variance times sample time") {
  const double sample_time = 5.0;
  const Spectrum spectrum = welch(test::white(std::size_t{20'000}, 3U), sample_time);
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

}  // namespace
}  // namespace mpm::spectrum_test
