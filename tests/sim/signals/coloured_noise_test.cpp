#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "sim/signals/coloured_noise.hpp"
#include "sim/signals/random_stream.hpp"
#include "sim/signals/setpoints.hpp"

using namespace mpm::sim;
using mpm::config::NoiseSettings;
using mpm::config::SetpointSettings;

TEST_CASE("normal numbers have the moments of a normal distribution") {
  RandomStream stream(1, StreamPurpose::kNoise, 0);
  constexpr int kCount = 200000;
  double sum = 0.0, squares = 0.0, fourth = 0.0, product = 0.0, last = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = stream.normal();
    sum += value;
    squares += value * value;
    fourth += value * value * value * value;
    product += value * last;
    last = value;
  }
  // Four standard errors: sd of the mean 1, of the square sqrt(2), of the 4th power sqrt(96), of
  // the product of neighbours 1, each over sqrt(n).
  const double error = 4.0 / std::sqrt(kCount);
  CHECK(std::abs(sum / kCount) < error);
  CHECK(std::abs(squares / kCount - 1.0) < error * std::sqrt(2.0));
  CHECK(std::abs(fourth / kCount - 3.0) < error * std::sqrt(96.0));
  CHECK(std::abs(product / kCount) < error);
}

TEST_CASE("streams of other seeds, purposes and indices are other numbers") {
  std::set<double> first;
  for (const std::uint64_t seed : {0U, 1U, 2U})
    for (const StreamPurpose purpose : {StreamPurpose::kNoise, StreamPurpose::kSetpoint})
      for (const std::uint64_t index : {0U, 1U, 2U})
        first.insert(RandomStream(seed, purpose, index).uniform());
  CHECK(first.size() == 18);
  CHECK(RandomStream(7, StreamPurpose::kNoise, 3).uniform() ==
        RandomStream(7, StreamPurpose::kNoise, 3).uniform());
}

TEST_CASE("whole numbers below a bound are even") {
  RandomStream stream(1, StreamPurpose::kHiddenChange, 0);
  int counts[5] = {};
  for (int i = 0; i < 50000; ++i) ++counts[stream.below(5)];
  for (const int count : counts) CHECK(std::abs(count - 10000) < 4 * 90);  // sd sqrt(n p q) = 89
}

TEST_CASE("coloured noise has the variance and memory of eq. 4.2") {
  ColouredNoise noise(NoiseSettings{0.01, 0.95}, RandomStream(1, StreamPurpose::kNoise, 0));
  constexpr int kCount = 400000;
  double squares = 0.0, product = 0.0, last = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = noise.next();
    squares += value * value;
    product += value * last;
    last = value;
  }
  // Variance sigma^2 / (1 - pole^2) = 1.0256e-3; n (1-pole)/(1+pole) independent samples' worth.
  CHECK(squares / kCount == Approx(1e-4 / (1.0 - 0.95 * 0.95)).epsilon(0.06));
  CHECK(product / squares == Approx(0.95).epsilon(0.005));
}

TEST_CASE("set-points hold, and are drawn one after the other") {
  const SetpointSettings settings{1.0, 99};
  RandomBinarySetpoints setpoints({{settings, 0}, {settings, 1}, {settings, 2}},
                                  Eigen::Vector3d(1.0, 2.0, 3.0), 5);
  Eigen::VectorXd last = setpoints.next();
  int changes = 0;
  for (int k = 1; k < 20000; ++k) {
    const Eigen::VectorXd now = setpoints.next();
    for (int cv = 0; cv < 3; ++cv) {
      CHECK(std::abs(now(cv) - (cv + 1.0)) == 1.0);
      if (now(cv) == last(cv)) continue;
      ++changes;
      CHECK(k % 99 == 33 * cv);  // hold / n_cv apart
    }
    last = now;
  }
  // Half of the 3 * 20000 / 99 = 606 draws turn the sign; sd 12.3.
  CHECK(std::abs(changes - 303) < 50);
}
