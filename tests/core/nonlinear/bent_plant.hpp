#pragma once

#include <cstdint>
#include <vector>

#include "core/mismatch/mismatch_detector.hpp"
#include "core/nonlinear/nonlinear_detector.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::test {

/// Two channels to one CV, sampled each second, of which the model is right but for what is given:
/// e = G_0 (square x_0^2 + product x_0 x_1 + gain_error x_0) + coloured noise. The inputs move to
/// any value, every 20 samples, and follow the CV's noise a little, as under a controller.
struct BentPlant {
  std::uint64_t seed = 0;
  double square = 0.0, product = 0.0, gain_error = 0.0, noise = 0.1;
  NonlinearTest test = NonlinearTest::kPolynomial;
  int samples = 2500;

  static ModelSpec spec() {
    return channel_model(2, 1,
                         {{0, 0, TransferFunction{2.0, {15.0}, 0, 2, false}},
                          {0, 1, TransferFunction{-1.0, {8.0}, 0, 0, false}}});
  }

  /// Calls each(k, linear, nonlinear) after each sample. Rows are taken every five.
  template <class Each>
  void follow(Each each) const {
    const LinearModel whole(spec());
    const RegressionShape shape{2, 1, 12, 4, {0.9355}};  // exp(-1 / 15)
    constexpr int kPatience = 5;
    MismatchDetector linear(shape, {{1.0, 0}}, samples, kPatience, whole);
    NonlinearDetector nonlinear(shape, whole, {test, {1.0, 0}, kPatience, 0.001, 0.25});
    LinearModel channel = whole.channel(0, 0);
    Eigen::VectorXd u(2), e(1), bent(1);
    double coloured_noise = 0.0;
    for (int k = 0; k < samples; ++k) {
      for (int i = 0; i < 2; ++i)
        u(i) =
            2.0 * uniform(seed * 10 + static_cast<std::uint64_t>(i), k / 20) + 0.3 * coloured_noise;
      coloured_noise = 0.8 * coloured_noise + noise * uniform(seed * 10 + 5, k);
      e(0) = coloured_noise + channel.output()(0);
      linear.update(u, e);
      nonlinear.add_sample(linear);
      if (k % kPatience == kPatience - 1) {
        linear.fold(0);
        nonlinear.take(0, linear);
      }
      bent(0) = square * u(0) * u(0) + product * u(0) * u(1) + gain_error * u(0);
      channel.advance(bent);
      each(k, linear, nonlinear);
    }
  }

  /// Of both channels, in the end.
  [[nodiscard]] std::vector<ChannelNonlinearity> run() const {
    std::vector<ChannelNonlinearity> results;
    follow([&](int k, MismatchDetector& linear, NonlinearDetector& nonlinear) {
      if (k + 1 < samples) return;
      nonlinear.evaluate(0, linear);
      results = {nonlinear.result(0, 0), nonlinear.result(0, 1)};
    });
    return results;
  }
};

}  // namespace mpm::test
