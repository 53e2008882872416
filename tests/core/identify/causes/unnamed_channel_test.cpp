#include "core/identify/causes/unnamed_channel.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::unnamed_channel_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 600;

/// y(k) = 2 u(k-1) + v(k-1), and `added`: channels without a lag, which are known by hand.
struct Bench {
  VectorXd u = test::telegraph(1, kRows, 9), v = test::telegraph(2, kRows, 7);
  ModelSpec model;
  Recording recording;
  Problem problem;
  CvFit fit;

  explicit Bench(const VectorXd& added)
      : model(test::model_of({{0, 0, TransferFunction{2.0, {}, 0, 0, false}, {}},
                              {0, 1, TransferFunction{1.0, {}, 0, 0, false}, {}}},
                             2, 1)),
        recording(test::recording_of(both(), 2.0 * delayed(u) + delayed(v) + added)),
        problem(model, 2, recording, Tolerances{}, NoiseModel{}),
        fit(problem.fit({}, 0, {0}).cvs.at(0)) {}

  [[nodiscard]] Eigen::MatrixXd both() const {
    Eigen::MatrixXd inputs(kRows, 2);
    inputs << u, v;
    return inputs;
  }
  static VectorXd delayed(const VectorXd& x) {
    VectorXd result = VectorXd::Zero(x.size());
    result.tail(x.size() - 1) = x.head(x.size() - 1);
    return result;
  }
  /// What has no name and still may be looked for.
  std::vector<Effect> find(const std::vector<Effect>& accepted = {}) {
    return unnamed(problem, accepted, {fit});
  }
  static std::vector<Effect> unnamed(Problem& problem, const std::vector<Effect>& accepted,
                                     const std::vector<CvFit>& without) {
    std::vector<Effect> found;
    for (const Cause* cause : {&causes::unnamed_swing(), &causes::unnamed_direction()})
      cause->propose({problem, accepted, without}, found);
    std::erase_if(found, [&](const Effect& mine) {
      return std::any_of(accepted.begin(), accepted.end(), [&](const Effect& other) {
        return !cause_of(mine).goes_with(other, mine);
      });
    });
    return found;
  }
};

std::vector<Effect> of_kind(const std::vector<Effect>& effects, int input, const Cause& cause) {
  std::vector<Effect> result;
  for (const Effect& effect : effects)
    if (subject_of(effect) == Subject{&cause, {0, input}}) result.push_back(effect);
  return result;
}

// A gain that swings seven times in the data: the channel's response times a sine of that
// frequency.
TEST_CASE("a channel's gain may swing with time") {
  const VectorXd sine = VectorXd::NullaryExpr(
      kRows, [](Index k) { return std::sin(2.0 * M_PI * 7.0 * double(k) / double(kRows)); });
  Bench bench(0.1 * test::white(4, kRows));
  Bench swinging(0.1 * test::white(4, kRows) +
                 0.3 * 2.0 * Bench::delayed(bench.u).cwiseProduct(sine));
  const std::vector<Effect> swings = of_kind(swinging.find(), 0, causes::unnamed_swing());
  REQUIRE(swings.size() == 2);
  REQUIRE(swings[0].coordinates.size() == 2);
  const VectorXd response = 2.0 * Bench::delayed(bench.u);
  CHECK(swings[0].shape->col(0).isApprox(response.cwiseProduct(sine), 1e-9));
}

// With one sample of lag the pole is e^-1. The response rises or falls by 2 where u does.
TEST_CASE("a channel may rise slower than it falls") {
  Bench bench(0.1 * test::white(5, kRows));
  const std::vector<Effect> found = of_kind(bench.find(), 0, causes::unnamed_direction());
  REQUIRE(found.size() == 1);
  const VectorXd response = 2.0 * Bench::delayed(bench.u);
  double expected = 0.0;
  for (Index k = 1; k < kRows; ++k) {
    expected = std::exp(-1.0) * expected - std::abs(response(k) - response(k - 1));
    CHECK((*found[0].shape)(k, 0) == Approx(expected).margin(1e-10));
  }
}

TEST_CASE("what was accepted is not looked for again") {
  Bench bench(0.1 * test::white(6, kRows));
  const std::vector<Effect> accepted = of_kind(bench.find(), 0, causes::unnamed_direction());
  REQUIRE(accepted.size() == 1);
  const std::vector<Effect> rest = bench.find(accepted);
  CHECK(of_kind(rest, 0, causes::unnamed_direction()).empty());
  CHECK(of_kind(rest, 1, causes::unnamed_direction()).size() == 1);
}

}  // namespace
}  // namespace mpm::unnamed_channel_test
