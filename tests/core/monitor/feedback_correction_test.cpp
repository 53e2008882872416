#include "core/monitor/feedback_correction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/model/linear_model.hpp"
#include "tests/core/channel_model.hpp"

namespace mpm::feedback_correction_test {
namespace {

/// What a run looks like: how noise compares to the measurement's range, how far the three models
/// are from one another, and who moves the input.
struct Kind {
  double noise = 0.01;
  bool other_plant = true;   // than the controller's model
  bool other_file = false;   // than the controller's model
  bool closed = false;       // under a PI controller; else random steps
  bool disturbance = false;  // measured, in the controller's model alone
};

double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(random);
}

TransferFunction channel(std::mt19937_64& random) {
  TransferFunction f;
  f.gain = between(random, 0.5, 2.0);
  f.time_constants_s = {between(random, 2.0, 40.0)};
  if (between(random, 0.0, 1.0) < 0.5) f.time_constants_s.push_back(between(random, 1.0, 15.0));
  f.dead_time_s = std::floor(between(random, 0.0, 8.0));
  return f;
}

TransferFunction near(TransferFunction f, std::mt19937_64& random) {
  f.gain *= between(random, 0.5, 1.8);
  for (double& t : f.time_constants_s) t *= between(random, 0.5, 2.0);
  f.dead_time_s += std::floor(between(random, 0.0, 4.0));
  return f;
}

LinearModel model_of(const TransferFunction& u, const TransferFunction& d) {
  return LinearModel(test::channel_model(2, 1, {{0, 0, u}, {0, 1, d}}));
}

double rounded(double value, double step) {
  return step > 0.0 ? std::round(value / step) * step : value;
}

/// When the predictions were said to be corrected, or not to be any more, within 1500 samples; -1:
/// not. `share`: by which they are; 0: not at all. `step`: what values are rounded to.
struct Outcome {
  int corrected_at = -1, over_at = -1;
  double share = 0.0;
};
Outcome run(const Kind& kind, double share, std::uint64_t seed, double step) {
  std::mt19937_64 random(seed);
  const TransferFunction u_file = channel(random), d_file = channel(random);
  const TransferFunction u_control = kind.other_file ? near(u_file, random) : u_file;
  const TransferFunction d_control = kind.other_file ? near(d_file, random) : d_file;
  TransferFunction none = d_file;
  none.gain = 0.0;
  const TransferFunction u_plant = kind.other_plant ? near(u_control, random) : u_control;
  LinearModel file = model_of(u_file, kind.disturbance ? none : d_file);
  LinearModel control = model_of(u_control, d_control);
  LinearModel plant = model_of(u_plant, kind.other_plant ? near(d_control, random) : d_control);
  FeedbackCorrection asked;
  Outcome outcome;
  double bias = share > 0.0 ? 50.0 : 0.0, integral = 0.0, noise = 0.0, setpoint = 0.0, u = 0.0,
         d = 0.0;
  std::normal_distribution<double> normal;
  for (int k = 0; k < 1500; ++k) {
    noise = 0.7 * noise + kind.noise * normal(random);
    const double y = rounded(50.0 + plant.output()(0) + noise, step);
    const double predicted = rounded(control.output()(0) + bias, step);
    asked.take(y, predicted, file.output()(0));
    if (asked.corrected() && outcome.corrected_at < 0) outcome.corrected_at = k;
    if (!asked.corrected() && outcome.corrected_at >= 0 && outcome.over_at < 0) outcome.over_at = k;
    bias += share * (y - predicted);
    if (k % 60 == 0) setpoint = normal(random);
    if (k % 45 == 0) d = normal(random);
    if (kind.closed) {
      const double error = setpoint - (y - 50.0);
      integral += 0.02 * error;
      u = 0.3 * error + integral;
    } else if (between(random, 0.0, 1.0) < 0.05) {
      u = normal(random);
    }
    const Eigen::Vector2d inputs(u, d);
    file.advance(inputs);
    control.advance(inputs);
    plant.advance(inputs);
  }
  outcome.share = asked.share();
  return outcome;
}

// Next to no noise is the hard part: then all that moves is what inputs do to three models.
TEST_CASE("predictions of a model are not taken for corrected ones") {
  int runs = 0, wrong = 0;
  for (const double noise : {1e-6, 1e-3, 0.02, 0.2})
    for (const bool closed : {false, true})
      for (const bool other_file : {false, true})
        for (const bool disturbance : {false, true})
          for (std::uint64_t seed = 1; seed <= 40; ++seed) {
            const Kind kind{noise, seed % 2 == 0, other_file, closed, disturbance};
            ++runs;
            const bool said =
                run(kind, 0.0, 1000 + seed, seed % 3 == 0 ? 0.01 : 0.0).corrected_at >= 0;
            if (said)
              UNSCOPED_INFO(noise << " " << closed << " " << other_file << " " << disturbance << " "
                                  << seed);
            wrong += said ? 1 : 0;
          }
  CHECK(wrong == 0);
  CHECK(runs == 4 * 8 * 40);
}

TEST_CASE("an output-bias update is seen within three blocks") {
  for (const double share : {0.05, 0.2, 0.6, 1.0})
    for (const double noise : {0.02, 0.2})
      for (const bool closed : {false, true}) {
        int seen = 0;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
          const Kind kind{noise, seed % 2 == 0, false, closed, false};
          const Outcome outcome = run(kind, share, 2000 + seed, 0.001);
          seen += outcome.corrected_at >= 0 && outcome.corrected_at <= 300 ? 1 : 0;
          if (outcome.corrected_at >= 0) CHECK(outcome.share == Approx(share).epsilon(0.2));
          CHECK(outcome.over_at == -1);
        }
        CAPTURE(share, noise, closed);
        CHECK(seen >= 18);
      }
}

}  // namespace
}  // namespace mpm::feedback_correction_test
