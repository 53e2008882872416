#include "core/identify/causes/square_wave_search.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::square_wave_search_test {
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
    const SquareWaves found = find_square_waves(bench.problem.data(0), bench.fit);
    const bool any =
        std::any_of(found.waves.begin(), found.waves.end(), [&](const SquareWave& candidate) {
          const double off = candidate.period / period - 1.0;
          double phase = std::fmod(candidate.begin - begin, 0.5 * period);
          if (phase > 0.25 * period) phase -= 0.5 * period;
          return candidate.onset == 0 && std::abs(off) * kRows <= 3.0 && std::abs(phase) <= 3.0;
        });
    CHECK(any);
    CHECK(found.looked_at > found.waves.size());
  }
}

}  // namespace
}  // namespace mpm::square_wave_search_test
