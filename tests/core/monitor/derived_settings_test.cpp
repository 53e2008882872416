#include "core/monitor/derived_settings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <variant>

namespace mpm {
namespace {

int fir_lags(decltype(ChannelSpec::dynamics) dynamics) {
  ModelSpec spec;
  spec.input_count = spec.cv_count = 1;
  spec.channels = {{0, 0, std::move(dynamics)}};
  return derive_settings(spec, LinearModel(spec), {}, {}).fir_lags;
}

// h(k + delay) = r^(k - 1) sin(k w) / sin w: changes its sign every pi / w samples, and each swing
// is r^(pi / w) of the one before.
DiscreteFilter swinging(double r, double half_period, int delay) {
  return {{1.0}, {1.0, -2.0 * r * std::cos(std::numbers::pi / half_period), r * r}, delay};
}

TEST_CASE("the pulse lags hold the dead time and what may be wrong with it") {
  CHECK(fir_lags(TransferFunction{2.0, {30.0}, 0.0, 3.0}) == 20);   // at least
  CHECK(fir_lags(TransferFunction{2.0, {30.0}, 0.0, 25.0}) == 38);  // and 13 samples
}

TEST_CASE("the pulse lags hold what swings, which tails cannot follow") {
  // Of swings of 1, 0.27, 0.072 and 0.019 the third is the last above a twentieth: 37.5 samples.
  CHECK(fir_lags(swinging(0.9, 12.5, 4)) == 38 + 4);
  CHECK(fir_lags(swinging(0.97, 20.0, 0)) == 60);  // 0.54 of the one before: at most
  CHECK(fir_lags(swinging(0.7, 12.5, 0)) == 20);   // 0.012
  // One change of sign and then a lag: an inverse response of 3 / (20 s + 1) - 2 / (5 s + 1).
  CHECK(fir_lags(TransferFunction{1.0, {20.0, 5.0}, -25.0, 0.0}) == 20);
}

}  // namespace
}  // namespace mpm
