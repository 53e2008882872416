#include "core/mismatch/mismatch_detector.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "core/statistics/f_distribution.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::mismatch_detector_test {
namespace {

ModelSpec first_order(int inputs, int cvs, double time_constant_s) {
  std::vector<ChannelSpec> channels;
  for (int j = 0; j < cvs; ++j)
    for (int i = 0; i < inputs; ++i)
      channels.push_back({j, i, TransferFunction{1.0 + i + j, {time_constant_s}, 0, 1, false}});
  return test::channel_model(inputs, cvs, std::move(channels));
}

void evaluate_all(MismatchDetector& detector) {
  for (int m = 0; m < detector.memory_count(); ++m)
    for (int j = 0; j < detector.shape().cvs; ++j)
      if (detector.memory(j, m).ready()) detector.evaluate(j, m);
}

TEST_CASE("the mismatch detector equals brute-force batch fits") {
  // Expected: tests/oracles/mismatch_detector.py; signals drawn alike.
  const nlohmann::json oracle = test::read_oracle("mismatch_detector.json");
  const int m = oracle["inputs"];
  const int n = oracle["cvs"];
  const LinearModel model(first_order(m, n, 10.0));
  MismatchDetector detector({m, n, oracle["fir_lags"], oracle["residual_order"],
                             oracle["tail_poles"].get<std::vector<double>>()},
                            {{oracle["lambda"], 0}}, 100, oracle["patience"], model);
  Eigen::VectorXd u(m), e(n), noise = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(2);
  for (int k = 0; k < oracle["samples"].get<int>(); ++k) {
    for (int i = 0; i < m; ++i) u(i) = test::coloured(static_cast<std::uint64_t>(1 + i), k);
    for (int j = 0; j < n; ++j) {
      const double w = test::uniform(static_cast<std::uint64_t>(20 + j), k);
      const double shock = w * w * w * w * w * 3 * (k > 350 ? 2.0 : 1.0);
      noise(j) = k == 0 ? 0.0 : 0.6 * noise(j) + shock;
    }
    e = noise;
    if (k >= 2) e(0) += 0.08 * before(1);
    before(1) = before(0);
    before(0) = u(1);
    detector.update(u, e);
  }
  evaluate_all(detector);
  for (int j = 0; j < n; ++j) {
    const double effective_rows = oracle["effective_rows"][static_cast<std::size_t>(j)];
    CHECK(detector.memory(j).effective_rows() == Approx(effective_rows).epsilon(1e-10));
    for (int i = 0; i < m; ++i) {
      // The oracle's F, divided by the factor for few rows that the evaluator's comment gives.
      const double per_freedom = detector.shape().columns() / detector.memory(j).freedom();
      const double plain =
          oracle["statistics"][static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      const double expected = plain / (1.0 + 0.26 * per_freedom + 1.0 * per_freedom * per_freedom);
      CAPTURE(j, i);
      const ChannelEvidence& evidence = detector.evidence(j, i);
      CHECK(evidence.block_statistic == Approx(expected).epsilon(1e-8));
      // Of three tests the best one counts, times three.
      const double block_p =
          f_upper_tail(expected, detector.shape().block(), detector.memory(j).freedom());
      CHECK(evidence.tests == 3);
      CHECK(evidence.p_value <= std::min(1.0, 3.0 * block_p) * (1.0 + 1e-6));
      CHECK(evidence.p_value ==
            Approx(std::min(1.0, 3.0 * f_upper_tail(evidence.statistic, evidence.numerator_freedom,
                                                    detector.memory(j).freedom())))
                .epsilon(1e-9));
    }
  }
}

// Independent inputs, white-ish noise, a gain error of `ratio` of the model in channel (0, 0).
struct OpenLoop {
  explicit OpenLoop(std::uint64_t seed_in) : seed(seed_in) {}
  std::uint64_t seed;
  double hidden_ratio = 0.0;
  std::vector<double> input_scale = {1.0, 1.0};
  bool same_inputs = false;

  void run(MismatchDetector& detector, const ModelSpec& spec, int samples) const {
    LinearModel model(spec);
    Eigen::VectorXd u(2), e(2), noise = Eigen::VectorXd::Zero(2);
    for (int k = 0; k < samples; ++k) {
      for (int i = 0; i < 2; ++i)
        u(i) = input_scale[static_cast<std::size_t>(i)] *
               (test::uniform(seed * 100 + static_cast<std::uint64_t>(i), k / 25) > 0 ? 1.0 : -1.0);
      if (same_inputs) u(1) = u(0);
      for (int j = 0; j < 2; ++j)
        noise(j) = 0.8 * noise(j) +
                   0.1 * test::uniform(seed * 100 + 50 + static_cast<std::uint64_t>(j), k);
      e = noise;
      e(0) += hidden_ratio * model.output()(0);
      detector.update(u, e);
      Eigen::VectorXd only_first = u;
      only_first(1) = 0.0;
      model.advance(only_first);
    }
    evaluate_all(detector);
  }
};

MismatchDetector make_test(const ModelSpec& spec, double lambda = 1.0) {
  return MismatchDetector({2, 2, 12, 4, {std::exp(-1.0 / 15.0)}}, {{lambda, 0}}, 2000, 1,
                          LinearModel(spec));
}

// A plant under feedback from a CV that walks and is measured with noise: what drives the input is
// the past of the noise, farther back than eight lags reach.
ChannelEvidence walk_under_feedback(std::uint64_t seed, const std::vector<double>& means) {
  const ModelSpec spec = first_order(1, 1, 15.0);
  LinearModel model(spec);
  RegressionShape shape{1, 1, 12, 8, {std::exp(-1.0 / 15.0)}};
  shape.residual_poles = means;
  MismatchDetector detector(shape, {{1.0, 0}}, 4000, 1, model);
  double walk = 0.0;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(1), e(1);
  for (int k = 0; k < 3000; ++k) {
    walk += 0.02 * test::uniform(seed * 10 + 1, k);
    e(0) = walk + 0.3 * test::uniform(seed * 10 + 2, k);
    detector.update(u, e);
    model.advance(u);
    // Integral action on the measured CV, and set-points now and then.
    const double measured = model.output()(0) + e(0);
    u(0) += 0.04 * (0.3 * test::uniform(seed * 10 + 3, k / 200) - measured);
  }
  evaluate_all(detector);
  return detector.evidence(0, 0);
}

TEST_CASE("noise that walks under feedback accuses no channel") {
  // 60 seeds, nothing wrong. Beyond doubt (p < 0.001) at most twice: were it nominal, more came in
  // one of 10^5 tests. With lags alone it is far more often: the effect is there to be found.
  const std::vector<double> means = {std::exp(-1.0 / 8.0), std::exp(-1.0 / 40.0)};
  int with_means = 0, with_lags = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    with_means += walk_under_feedback(seed, means).p_value < 1e-3 ? 1 : 0;
    with_lags += walk_under_feedback(seed, {}).p_value < 1e-3 ? 1 : 0;
  }
  CHECK(with_means <= 2);
  CHECK(with_lags >= 6);
}

TEST_CASE("the p-value of a matching channel keeps its promise") {
  // 100 seeds x 4 channels, fixed noise. The smaller of two p-values, doubled, is below a at most
  // with probability a, and at least with a / 2. Binomial(400, a): 5 % -> 10..20, s.d. 4.4;
  // 20 % -> 40..80, s.d. 8; the bounds are four s.d. wide (a fresh draw fails once in 10 000).
  const ModelSpec spec = first_order(2, 2, 15.0);
  int below_5 = 0;
  int below_20 = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    MismatchDetector detector = make_test(spec, 0.998);
    OpenLoop(seed).run(detector, spec, 1200);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        below_5 += detector.evidence(j, i).p_value < 0.05 ? 1 : 0;
        below_20 += detector.evidence(j, i).p_value < 0.2 ? 1 : 0;
      }
  }
  CAPTURE(below_5, below_20);
  CHECK(below_5 <= 38);
  CHECK(below_20 >= 8);
  CHECK(below_20 <= 112);
}

TEST_CASE("a hidden gain error is found in its channel, with its size and its s.d.") {
  // The hidden ratio is known; its estimate must lie within 4 predicted s.d. in every one of 20
  // seeds, and scatter by about as much as predicted (chi-square of 20: 7.4 .. 40 at 99.8 %).
  const ModelSpec spec = first_order(2, 2, 15.0);
  double chi_square = 0.0;
  for (std::uint64_t seed = 201; seed <= 220; ++seed) {
    MismatchDetector detector = make_test(spec);
    OpenLoop loop(seed);
    loop.hidden_ratio = 0.25;
    loop.run(detector, spec, 1500);
    const ChannelEvidence& found = detector.evidence(0, 0);
    CHECK(found.p_value < 1e-12);
    CHECK(found.reference_gain == Approx(1.0));
    CHECK(found.excitation_index < 0.05);
    const double z = (found.gain_error_ratio - 0.25) / found.excitation_index;
    CHECK(std::abs(z) < 4.0);
    chi_square += z * z;
    CHECK(detector.evidence(1, 0).p_value > 1e-5);
    CHECK(detector.evidence(0, 1).p_value > 1e-5);
    CHECK(detector.evidence(1, 1).p_value > 1e-5);
  }
  INFO("chi square " << chi_square);
  CHECK(chi_square > 5.9);
  CHECK(chi_square < 45.3);
}

TEST_CASE("a usual error is seen sooner than an unusual one of the same size") {
  // A small gain error on few samples: the directed test must say more than the
  // block test in most of 20 seeds (it concentrates 5 of 13 degrees of freedom on the truth).
  const ModelSpec spec = first_order(2, 2, 15.0);
  int directed = 0;
  for (std::uint64_t seed = 301; seed <= 320; ++seed) {
    MismatchDetector detector = make_test(spec);
    OpenLoop loop(seed);
    loop.hidden_ratio = 0.1;
    loop.run(detector, spec, 500);
    directed += detector.evidence(0, 0).numerator_freedom < detector.shape().block() ? 1 : 0;
  }
  CHECK(directed > 10);
}

TEST_CASE("excitation: silent, weak and inseparable inputs are told apart") {
  const ModelSpec spec = first_order(2, 2, 15.0);
  SECTION("an input that never moves says nothing") {
    MismatchDetector detector = make_test(spec);
    OpenLoop loop(7);
    loop.input_scale = {1.0, 0.0};
    loop.run(detector, spec, 1000);
    CHECK(std::isinf(detector.evidence(0, 1).excitation_index));
    CHECK(detector.evidence(0, 1).p_value == 1.0);
    CHECK(detector.evidence(0, 0).excitation_index < 0.1);
  }
  SECTION("a tenth of the movement: ten times the s.d.") {
    // The noise is the same and enters linearly, so the s.d. scales with 1 / movement exactly.
    MismatchDetector strong = make_test(spec);
    MismatchDetector weak = make_test(spec);
    OpenLoop loop(8);
    loop.run(strong, spec, 1000);
    loop.input_scale = {1.0, 0.1};
    loop.run(weak, spec, 1000);
    CHECK(weak.evidence(0, 1).excitation_index ==
          Approx(10.0 * strong.evidence(0, 1).excitation_index).epsilon(1e-6));
  }
  SECTION("of a channel that the model lacks a usual gain counts, not one that would show") {
    // What is left of the gains is 1, 2 and 2: products would make the missing one 2 * 2 / 1.
    ModelSpec lacking = spec;
    lacking.channels.pop_back();
    MismatchDetector detector = make_test(lacking);
    OpenLoop loop(10);
    loop.input_scale = {1.0, 0.01};
    loop.run(detector, lacking, 1000);
    CHECK(detector.evidence(1, 1).reference_gain == Approx(4.0));
    CHECK(detector.evidence(1, 1).excitation_index > 0.25);
    // Where the input moves a hundred times as much, what the other one has done to the CV is less.
    MismatchDetector moved = make_test(lacking);
    loop.input_scale = {1.0, 1.0};
    loop.run(moved, lacking, 1000);
    CHECK(moved.evidence(1, 1).reference_gain == Approx(2.0).epsilon(0.1));
    CHECK(moved.evidence(1, 1).excitation_index < 0.1);
  }
  SECTION("two inputs that move as one name each other") {
    MismatchDetector detector = make_test(spec);
    OpenLoop loop(9);
    loop.same_inputs = true;
    loop.hidden_ratio = 0.5;
    loop.run(detector, spec, 1000);
    CHECK(detector.evidence(0, 0).excitation_index > 100.0);
    CHECK(detector.evidence(0, 0).excitation_index_alone < 0.1);
    CHECK(detector.evidence(0, 0).confounder == 1);
    CHECK(detector.evidence(0, 1).confounder == 0);
  }
}

TEST_CASE("units of any size give the same verdict") {
  // CV in units 1e6 times smaller, input 1: 1e-6 times: F, p and the relative error are unchanged.
  const ModelSpec spec = first_order(2, 2, 15.0);
  MismatchDetector plain = make_test(spec);
  MismatchDetector scaled = make_test(spec);
  LinearModel model(spec);
  Eigen::VectorXd u(2), e(2), scaled_u(2), scaled_e(2);
  for (int k = 0; k < 800; ++k) {
    for (std::uint64_t i = 0; i < 2; ++i) {
      u(static_cast<int>(i)) = test::coloured(300 + i, k);
      e(static_cast<int>(i)) = test::coloured(310 + i, k);
    }
    scaled_u << u(0) * 0x1p-20, u(1);
    scaled_e << e(0) * 0x1p20, e(1);
    plain.update(u, e);
    scaled.update(scaled_u, scaled_e);
  }
  evaluate_all(plain);
  evaluate_all(scaled);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i)
      CHECK(scaled.evidence(j, i).statistic ==
            Approx(plain.evidence(j, i).statistic).epsilon(1e-9));
}

TEST_CASE("the mismatch detector allocates nothing per sample") {
  const ModelSpec spec = first_order(3, 3, 50.0);
  MismatchDetector detector({3, 3, 20, 8, {0.98}}, {{0.9995, 0}, {1.0, 500}}, 600, 8,
                            LinearModel(spec));
  Eigen::VectorXd u(3), e(3);
  const std::uint64_t before = test::allocation_count();
  for (int k = 0; k < 600; ++k) {
    for (std::uint64_t i = 0; i < 3; ++i) {
      u(static_cast<int>(i)) = test::coloured(400 + i, k);
      e(static_cast<int>(i)) = test::coloured(410 + i, k);
    }
    if (k == 450) detector.skip(3);
    if (k == 500) u(1) = e(2) = std::nan("");
    detector.update(u, e);
    if (k == 590) detector.start_afresh(1, 560);
    evaluate_all(detector);
  }
  CHECK(detector.memory(0).ready());
  CHECK(test::allocation_count() == before);
}

}  // namespace
}  // namespace mpm::mismatch_detector_test
