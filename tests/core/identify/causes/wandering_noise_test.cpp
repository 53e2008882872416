#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/identify/causes/square_wave_search.hpp"
#include "core/identify/causes/step_moments.hpp"

// What is hidden: a step of 1 at row 613 in wandering noise whose own changes over a hundred rows
// are larger, and a square wave. Both are found at their very row, since whitening makes them
// pulses of several s.d.; without them nothing stands out so.
namespace {

using Eigen::VectorXd;
using namespace mpm;

constexpr Eigen::Index kRows = 2000;

/// r(k) = 0.98 r(k-1) + 0.15 e(k): s.d. 0.75.
VectorXd wandering_noise(unsigned seed) {
  std::mt19937_64 random(seed);
  VectorXd noise(kRows);
  double last = 0.0;
  for (double& value : noise) {
    // Irwin-Hall: the same on every platform.
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1.0p-53;
    value = last = 0.98 * last + 0.15 * sum;
  }
  return noise;
}

struct Fitted {
  CvData data;
  CvFit fit;
};

Fitted fitted(const VectorXd& residual) {
  Fitted result;
  result.data.measured = residual;
  result.data.known = result.data.weights = VectorXd::Ones(kRows);
  result.data.rows = kRows;
  result.fit.residual = residual;
  result.fit.noise = fit_whitening(residual, result.data.weights, {8, 0.0});
  result.fit.innovations = result.fit.noise.apply(residual);
  result.fit.variance = result.fit.innovations.squaredNorm() / kRows;
  return result;
}

}  // namespace

TEST_CASE("a step in wandering noise is found at its row") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    VectorXd residual = wandering_noise(seed);
    residual.tail(kRows - 613).array() += 1.0;  // 6.7 s.d. of the innovations
    const Fitted found = fitted(residual);
    const auto moments = step_moments(found.data, found.fit, {}, 5);
    INFO("seed " << seed);
    REQUIRE(moments.size() == 5);
    CHECK(moments[0] == 613);
    for (std::size_t i = 1; i < moments.size(); ++i) CHECK(std::abs(moments[i] - 613) >= 4);
  }
}

TEST_CASE("a step through a lag is found within its rise") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    VectorXd residual = wandering_noise(seed);
    for (Eigen::Index k = 900; k < kRows; ++k)
      residual(k) += 4.0 * (1.0 - std::exp(-static_cast<double>(k - 900) / 15.0));
    const Fitted found = fitted(residual);
    const auto moments = step_moments(found.data, found.fit, {15.0, 0.0}, 3);
    INFO("seed " << seed);
    REQUIRE(!moments.empty());
    CHECK(std::abs(moments[0] - 900) <= 8);
  }
}

TEST_CASE("a square wave in wandering noise is found with its period and its edges") {
  ModelSpec model;
  model.sample_time_s = 2.0;
  model.cv_count = model.input_count = 1;
  model.channels = {{0, 0, TransferFunction{1.0, {20.0}}, {}}};
  model.input_blocks.resize(1);
  model.output_blocks.resize(1);
  model.input_origin = model.output_origin = VectorXd::Zero(1);
  int right = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    VectorXd residual = wandering_noise(seed);
    constexpr double kPeriod = 88.5;  // rows
    for (Eigen::Index k = 0; k < kRows; ++k)
      residual(k) += std::fmod(static_cast<double>(k) + 70.0, kPeriod) < 0.5 * kPeriod ? 0.3 : -0.3;
    const Fitted found = fitted(residual);
    Recording recording{0.0, 2.0, Eigen::MatrixXd::Zero(kRows, 1), residual,
                        Eigen::MatrixXd(kRows, 0)};
    const Problem problem(model, 1, recording, Tolerances{}, {8, 0.0});
    const std::vector<SquareWave> waves = find_square_waves(problem.data(0), found.fit).waves;
    INFO("seed " << seed);
    REQUIRE(!waves.empty());
    if (std::abs(waves[0].period - kPeriod) < 0.1) ++right;
  }
  CHECK(right >= 9);  // pulses of 4 s.d. at 45 edges: 28 s.d. together; one may end in a multiple
}
