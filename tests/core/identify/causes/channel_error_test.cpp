#include "core/identify/causes/channel_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

Surroundings every_second() {
  Surroundings surroundings;
  surroundings.sample_time_s = 1.0;
  return surroundings;
}

Effect error_of(const Coordinate& coordinate, Place place = {0, 0}) {
  return {&causes::gain(), place, {coordinate}};
}

// A gain 20 % too high is 20 % of every value. A lag of 20 s in place of 10 s, until 1 - p^k is
// within 5 % of its end: by its closed form.
TEST_CASE("what an error of a channel does to its step response, as a share of it") {
  const ModelSpec model =
      test::model_of({test::lag(1, 0, 3.0, 5.0), test::lag(0, 0, 2.0, 10.0)}, 1, 2);
  Coordinate gain = gain_ratio_coordinate();
  gain.value = 1.2;
  CHECK(share_of_step(error_of(gain), every_second(), model) == Approx(0.2));

  double off = 0.0, all = 0.0;
  for (int k = 0; k <= static_cast<int>(std::ceil(-10.0 * std::log(0.05))); ++k) {
    const double given = 1.0 - std::exp(-k / 10.0), slow = 1.0 - std::exp(-k / 20.0);
    off += (slow - given) * (slow - given);
    all += given * given;
  }
  const Coordinate slow = time_constant_coordinate(std::log(2.0));
  CHECK(share_of_step(error_of(slow), every_second(), model) ==
        Approx(std::sqrt(off / all)).epsilon(0.02));
  CHECK(share_of_step(error_of(slow, {0, 1}), every_second(), model) == 0.0);
}

}  // namespace
}  // namespace mpm
