#include "core/identify/search/search.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using test::lag;

constexpr Index kRows = 900;

// A gain in one CV and a time constant in the other: the truth is the test's own.
TEST_CASE("a search names one cause after the other and then ends") {
  Eigen::MatrixXd u(kRows, 2), y(kRows, 2);
  u << test::telegraph(1, kRows, 12), test::telegraph(3, kRows, 9);
  y.col(0) = 1.3 * test::first_order(u.col(0), 2.0, 10.0) + 0.1 * test::white(4, kRows);
  y.col(1) = test::first_order(u.col(1), -1.0, 10.0) + 0.1 * test::white(5, kRows);
  const ModelSpec two = test::model_of({lag(0, 0, 2.0, 10.0), lag(1, 1, -1.0, 5.0)}, 2, 2);
  const Recording recording = test::recording_of(u, y);
  Problem problem(two, 2, recording, Tolerances{}, NoiseModel{});
  const SearchResult found = search(problem, SearchSettings{});
  REQUIRE(found.named.size() == 2);
  CHECK(found.fit.effects.size() == 2);
  for (const Named& named : found.named) {
    CHECK(named.evidence > 3.0);
    CHECK(named.confidence > 0.9);
    if (named.effect.place.cv == 0) {
      CHECK(subject_of(named.effect) == Subject{&causes::gain(), {0, 0}});
      CHECK(named.effect.value(kGainRatio, 1.0) == Approx(1.3).margin(0.03));
    } else {
      CHECK(subject_of(named.effect) == Subject{&causes::time_constant(), {1, 1}});
      CHECK(std::exp(named.effect.value(kTimeConstantRatio, 0.0)) == Approx(2.0).margin(0.2));
    }
  }
  SearchSettings one;
  one.max_findings = 1;
  CHECK(search(problem, one).named.size() == 1);
}

}  // namespace
}  // namespace mpm
