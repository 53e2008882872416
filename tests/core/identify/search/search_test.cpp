#include "core/identify/search/search.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
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

// A level of 2 beside a gain of 1.3 times the model's, which by itself would shift the CV too: with
// no levels to be named it is told where the gain is, and not where that may not be either.
TEST_CASE("a level is told beside what is wrong with a channel, else only where it may be") {
  const Eigen::VectorXd u = test::telegraph(1, kRows, 12);
  const Eigen::VectorXd y =
      (1.3 * test::first_order(u, 2.0, 10.0) + 0.1 * test::white(4, kRows)).array() + 2.0;
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const Recording recording = test::recording_of(u, y);
  const auto levels = [&](const std::function<bool(const Effect&)>& may_name) {
    Problem problem(model, 1, recording, Tolerances{}, NoiseModel{});
    SearchSettings settings;
    settings.may_name = may_name;
    std::vector<double> sizes;
    for (const Named& named : search(problem, settings).named)
      if (causes::is_constant_offset(named.effect))
        sizes.push_back(named.effect.coordinates[0].value);
    return sizes;
  };
  const auto no_level = [](const Effect& effect) { return !causes::is_constant_offset(effect); };
  const std::vector<double> beside = levels(no_level);
  REQUIRE(beside.size() == 1);
  CHECK(beside[0] == Approx(2.0).margin(0.05));
  CHECK(levels([&](const Effect& effect) {
          return no_level(effect) && !cause_of(effect).acts_through_channels();
        }).empty());
}

}  // namespace
}  // namespace mpm
