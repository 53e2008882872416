#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::periodic_disturbance_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 600;

/// sign of sin 2 pi (k - begin) / period.
VectorXd wave(double begin, double period) {
  return VectorXd::NullaryExpr(kRows, [&](Index k) {
    const double phase = (static_cast<double>(k) - begin) / period;
    return phase - std::floor(phase) < 0.5 ? 1.0 : -1.0;
  });
}

const Cause& periodic() { return causes::periodic_disturbance(); }
const Quantity& begins() { return test::quantity_of(periodic(), "begin"); }
const Quantity& periods() { return test::quantity_of(periodic(), "period"); }

struct Bench {
  VectorXd u = test::telegraph(1, kRows, 12);
  ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording recording;
  Problem problem;

  explicit Bench(const VectorXd& added)
      : recording(test::recording_of(u, test::first_order(u, 2.0, 10.0) + added)),
        problem(model, 1, recording, Tolerances{}, NoiseModel{}) {}

  std::vector<Effect> square_waves() {
    const std::vector<Effect> accepted;
    const std::vector<CvFit> without = problem.fit({}, 0, {0}).cvs;
    std::vector<Effect> found;
    periodic().propose({problem, accepted, without}, found);
    std::erase_if(found, [](const Effect& effect) { return !effect.find(periods()); });
    return found;
  }
};

// Hidden by the test with a period and a phase that it knows. A period that is off by d moves the
// last edge by kRows d / period: found to within a row of that.
TEST_CASE("a square wave is proposed with its period and its phase") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double period = 47.0 + 8.0 * static_cast<double>(seed), begin = 9.0;
    CAPTURE(seed, period);
    Bench bench(0.5 * wave(begin, period) + 0.1 * test::white(10 + seed, kRows));
    const std::vector<Effect> found = bench.square_waves();
    REQUIRE_FALSE(found.empty());
    const bool any = std::any_of(found.begin(), found.end(), [&](const Effect& effect) {
      const double off = effect.value(periods(), 0.0) / period - 1.0;
      double phase = std::fmod(effect.value(begins(), 0.0) - begin, 0.5 * period);
      if (phase > 0.25 * period) phase -= 0.5 * period;
      return effect.onset == 0 && std::abs(off) * kRows <= 3.0 && std::abs(phase) <= 3.0;
    });
    CHECK(any);
    for (const Effect& effect : found) {
      CHECK_FALSE(periodic().stepping(effect).reaches.empty());
      CHECK(subject_of(effect) == Subject{&periodic(), {0}});
      CHECK(effect.search_cost > 0.0);
    }
  }
}

TEST_CASE("a sine has no edges to be stepped about") {
  const Quantity &sines = test::quantity_of(periodic(), "sine"),
                 &cosines = test::quantity_of(periodic(), "cosine"),
                 &frequency = test::quantity_of(periodic(), "frequency");
  const Effect sine{&periodic(), {0}, {{&sines}, {&cosines}, {&frequency}}};
  CHECK(periodic().stepping(sine).reaches.empty());
  CHECK(causes::step_disturbance().stepping(sine).reaches.empty());
}

// By hand: 600 s hold 10 cycles of 60 s. A phase moved by +-3 s; and a period moved by +-3 / 10 s
// with a phase of half as much the other way, so that the middle edges stay.
TEST_CASE("the edges of a wave are moved by its phase or by its period") {
  const Bench bench(0.5 * wave(9.0, 60.0) + 0.1 * test::white(3, kRows));
  const Effect effect{&periodic(), {0}, {{&kSize, 0.5}, {&begins(), 9.0}, {&periods(), 60.0}}};
  REQUIRE(periodic().stepping(effect).neighbours == 4);
  const auto is = [&](int i, double begin, double period) {
    CAPTURE(i);
    const Effect other = periodic().neighbour(effect, 3.0, i, bench.problem);
    CHECK(other.value(begins(), 0.0) == Approx(begin));
    CHECK(other.value(periods(), 0.0) == Approx(period));
    CHECK(other.value(kSize, 0.0) == 0.5);
  };
  is(0, 6.0, 60.0);
  is(1, 10.5, 59.7);
  is(2, 12.0, 60.0);
  is(3, 7.5, 60.3);
}

}  // namespace
}  // namespace mpm::periodic_disturbance_test
