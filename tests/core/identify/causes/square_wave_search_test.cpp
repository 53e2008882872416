#include "core/identify/square_waves.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 600;

/// sign of sin 2 pi (k - begin) / period, begun at `begin`.
VectorXd wave(double begin, double period) {
  return VectorXd::NullaryExpr(kRows, [&](Index k) {
    const double phase = (static_cast<double>(k) - begin) / period;
    return phase - std::floor(phase) < 0.5 ? 1.0 : -1.0;
  });
}

struct Bench {
  VectorXd u = test::telegraph(1, kRows, 12);
  ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0)}, 1, 1);
  Recording recording;
  Problem problem;
  CvFit fit;

  explicit Bench(const VectorXd& added)
      : recording(test::recording_of(u, test::first_order(u, 2.0, 10.0) + added)),
        problem(model, 1, recording, Tolerances{}, NoiseModel{}),
        fit(problem.fit({}, 0, {0}).cvs.at(0)) {}
};

// Hidden by the test with a period and a phase that it knows. A period that is off by d moves the
// last edge by kRows d / period: found to within a row of that.
TEST_CASE("the period and the phase of a square wave are found") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const double period = 47.0 + 8.0 * static_cast<double>(seed), begin = 9.0;
    CAPTURE(seed, period);
    const Bench bench(0.5 * wave(begin, period) + 0.1 * test::white(10 + seed, kRows));
    const std::vector<Effect> found = square_waves(bench.problem, bench.fit);
    REQUIRE_FALSE(found.empty());
    const bool any = std::any_of(found.begin(), found.end(), [&](const Effect& effect) {
      const double off = effect.value("period", 0.0) / period - 1.0;
      double phase = std::fmod(effect.value("begin", 0.0) - begin, 0.5 * period);
      if (phase > 0.25 * period) phase -= 0.5 * period;
      return effect.onset == 0 && std::abs(off) * kRows <= 3.0 && std::abs(phase) <= 3.0;
    });
    CHECK(any);
    for (const Effect& effect : found) {
      CHECK(is_square_wave(effect));
      CHECK(effect.subject.cause == Cause::kOutputDisturbance);
      CHECK(effect.subject.cv == 0);
      CHECK(effect.search_cost > 0.0);
    }
  }
}

TEST_CASE("a sine is no square wave") {
  Effect sine;
  sine.subject = {Cause::kOutputDisturbance, 0, -1, -1, "periodic"};
  sine.coordinates = {{"sine"}, {"cosine"}, {"frequency"}};
  CHECK_FALSE(is_square_wave(sine));
  sine.subject.kind = "step";
  CHECK_FALSE(is_square_wave(sine));
}

// By hand: 600 s hold 10 cycles of 60 s. A phase moved by +-3 s; and a period moved by +-3 / 10 s
// with a phase of half as much the other way, so that the middle edges stay.
TEST_CASE("the edges of a wave are moved by its phase or by its period") {
  const Bench bench(0.5 * wave(9.0, 60.0) + 0.1 * test::white(3, kRows));
  Effect effect;
  effect.subject = {Cause::kOutputDisturbance, 0, -1, -1, "periodic"};
  effect.coordinates = {{"size", 0.5}, {"begin", 9.0}, {"period", 60.0}};
  const std::vector<Effect> others = other_edges(effect, 3.0, bench.problem);
  REQUIRE(others.size() == 4);
  const auto is = [&](std::size_t i, double begin, double period) {
    CAPTURE(i);
    CHECK(others[i].value("begin", 0.0) == Approx(begin));
    CHECK(others[i].value("period", 0.0) == Approx(period));
    CHECK(others[i].value("size", 0.0) == 0.5);
  };
  is(0, 6.0, 60.0);
  is(1, 10.5, 59.7);
  is(2, 12.0, 60.0);
  is(3, 7.5, 60.3);
}

}  // namespace
}  // namespace mpm
