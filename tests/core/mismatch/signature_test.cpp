#include "core/mismatch/signature.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace mpm {
namespace {

TEST_CASE("a mean of the own past filters an error like the lags that it stands for") {
  // Closed form: (1 - q) sum q^m z^-(p+1+m) is an infinite row of lags; of 0.4^m, 40 are all.
  constexpr int kOrder = 3;
  constexpr double kPole = 0.4, kOfMean = 0.35;
  const BlockBasis basis(50, {std::exp(-1.0 / 12.0), std::exp(-1.0 / 3.0)});
  Eigen::VectorXd pulse = Eigen::VectorXd::Zero(basis.length());
  for (int l = 2; l < basis.length(); ++l) pulse(l) = std::exp(-(l - 2) / 12.0);
  const std::vector<double> lags = {0.5, -0.2, 0.1};

  std::vector<double> with_mean = lags;
  with_mean.push_back(kOfMean);
  Eigen::VectorXd found(basis.columns());
  Signature(basis, pulse, kOrder, {kPole}).filter(with_mean.data(), found);

  std::vector<double> long_lags = lags;
  for (int m = 0; m < 40; ++m) long_lags.push_back(kOfMean * (1.0 - kPole) * std::pow(kPole, m));
  Eigen::VectorXd expected(basis.columns());
  Signature(basis, pulse, static_cast<int>(long_lags.size())).filter(long_lags.data(), expected);

  REQUIRE(expected.norm() > 0.5);
  CHECK((found - expected).norm() < 1e-9);
}

TEST_CASE("an integrator with a longer lag rises as steeply, only later") {
  // Step response t - T (1 - exp(-t / T)); its derivative by ln T, with z = t / T, is
  // -T (1 - exp(-z) (1 + z)): bounded, while that of a gain error grows for ever.
  constexpr double kLag = 20.0;
  constexpr int kLength = 400;
  Eigen::VectorXd pulse = Eigen::VectorXd::Zero(kLength), ramp = pulse;
  const auto step = [](double t) { return t - kLag * (1.0 - std::exp(-t / kLag)); };
  for (int l = 1; l < kLength; ++l) pulse(l) = step(l) - step(l - 1);
  const std::vector<Eigen::VectorXd> errors = usual_errors(pulse, true);
  double sum = 0.0;
  for (int l = 1; l < kLength; ++l) {
    sum += errors[1](l);
    const double z = l / kLag;
    CHECK(sum == Approx(-kLag * (1.0 - std::exp(-z) * (1.0 + z))).margin(0.06 * kLag));
  }
  for (int l = 1; l < kLength; ++l) ramp(l) = 0.3;
  CHECK(usual_errors(ramp, true)[1].norm() == 0.0);  // without lag nothing is slower
  CHECK(usual_errors(pulse, false)[1].sum() < -5.0 * kLag);
}

}  // namespace
}  // namespace mpm
