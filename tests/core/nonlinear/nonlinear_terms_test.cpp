#include "core/nonlinear/nonlinear_terms.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/allocation_counter.hpp"
#include "tests/core/channel_model.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::nonlinear_terms_test {
namespace {

constexpr int kDepth = 400;
const RegressionShape kShape{3, 1, 5, 2, {0.9}};

// Two channels, and an input that the CV does not know.
LinearModel model() {
  return LinearModel(test::channel_model(3, 1,
                                         {{0, 0, TransferFunction{1.0, {4.0}, 0, 1, false}},
                                          {0, 1, TransferFunction{-3.0, {9.0}, 0, 0, false}}}));
}

Eigen::VectorXd moves(int k) {
  Eigen::VectorXd u(3);
  for (int i = 0; i < 3; ++i) u(i) = 2.0 + test::uniform(static_cast<std::uint64_t>(i), k / 7);
  return u;
}

struct Run {
  RegressionHistory history{kShape, kDepth};
  NonlinearTerms terms;
  explicit Run(NonlinearTest kind, double noise = 0.0) : terms(model(), 0, 0.9, kind, 10) {
    for (int k = 0; k < kDepth; ++k)
      history.push(moves(k), Eigen::VectorXd::Constant(1, noise * test::uniform(9, k)));
    terms.begin(history, kDepth);
    for (int age = kDepth - 1; age >= 0; --age) terms.advance(history, age);
  }
  void step(int k) {
    history.push(moves(k), Eigen::VectorXd::Zero(1));
    terms.advance(history, 0);
  }
};

}  // namespace

TEST_CASE("a column of the square is the channel's answer to the square") {
  Run run(NonlinearTest::kPolynomial);
  // Per input square, cube, play, where the channel stands and its square; three products; the
  // sum's cube; twice.
  REQUIRE(run.terms.columns() == 2 * (3 * 5 + 3 + 1));
  // By hand: standardised by the mean and s.d. of the history, through the same channel, at rest at
  // the oldest sample.
  double sum = 0.0, square = 0.0;
  for (int k = 0; k < kDepth; ++k) sum += moves(k)(1);
  const double mean = sum / kDepth;
  for (int k = 0; k < kDepth; ++k) square += std::pow(moves(k)(1) - mean, 2);
  const double deviation = std::sqrt(square / kDepth);
  LinearModel channel = model().channel(0, 1);
  const auto value = [&](int k) {
    return Eigen::VectorXd::Constant(1, std::pow((moves(k)(1) - mean) / deviation, 2));
  };
  channel.reset_steady(value(0));
  std::vector<double> answers;
  for (int k = 0; k < kDepth; ++k) {
    answers.push_back(channel.output()(0));
    channel.advance(value(k));
  }
  Eigen::VectorXd row(run.terms.columns());
  const int half = run.terms.columns() / 2;
  for (const int age : {0, 5}) {
    run.terms.fill(age, row.data());
    const auto at = static_cast<std::size_t>(kDepth - 1 - age);
    CHECK(row(run.terms.square_of(1)) == Approx(answers[at]).epsilon(1e-9));
    CHECK(row(half + run.terms.square_of(1)) == Approx(answers[at - 1]).epsilon(1e-9));
  }
  CHECK(run.terms.coefficient_of(1, 0.4) == Approx(0.1 * deviation));
  CHECK(run.terms.coefficient_of(2, 0.4) == 0.0);
}

TEST_CASE("how many columns there are is known beforehand") {
  // Counted from the list in the header, two lags each: of three inputs 3 x 5 and 3 pairs and the
  // sum's cube; a kernel has 5 + 1 + 1 + 5 of an input, 6 of a pair and 4 of the sum.
  CHECK(NonlinearTerms::columns_of(NonlinearTest::kOff, 3) == 0);
  CHECK(NonlinearTerms::columns_of(NonlinearTest::kPolynomial, 3) == 2 * (3 * 5 + 3 + 1));
  CHECK(NonlinearTerms::columns_of(NonlinearTest::kKernel, 3) == 2 * (3 * 12 + 3 * 6 + 4));
  for (const NonlinearTest test :
       {NonlinearTest::kPolynomial, NonlinearTest::kKernel, NonlinearTest::kRandomFeatures})
    CHECK(Run(test).terms.columns() == NonlinearTerms::columns_of(test, 3));
}

TEST_CASE("where a channel stands is what the model gives of it and the residual") {
  Run run(NonlinearTest::kPolynomial, 2.0);
  // By hand, as above: what the standardised input gives, in the CV's units, and the residual; of
  // that, standardised, the square through the same channel.
  const auto moments = [](const std::vector<double>& values) {
    double sum = 0.0, square = 0.0;
    for (const double value : values) sum += value;
    for (const double value : values) square += std::pow(value - sum / kDepth, 2);
    return std::pair(sum / kDepth, std::sqrt(square / kDepth));
  };
  std::vector<double> inputs, stands;
  for (int k = 0; k < kDepth; ++k) inputs.push_back(moves(k)(1));
  const auto [mean, deviation] = moments(inputs);
  const auto given = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  LinearModel channel = model().channel(0, 1), behind = model().channel(0, 1);
  channel.reset_steady(given((inputs.front() - mean) / deviation));
  for (int k = 0; k < kDepth; ++k) {
    stands.push_back(deviation * channel.output()(0) + 2.0 * test::uniform(9, k));
    channel.advance(given((inputs[static_cast<std::size_t>(k)] - mean) / deviation));
  }
  const auto [centre, scale] = moments(stands);
  const auto square = [&, c = centre, s = scale](std::size_t k) {
    return given(std::pow((stands[k] - c) / s, 2));
  };
  behind.reset_steady(square(0));
  for (std::size_t k = 0; k + 1 < kDepth; ++k) behind.advance(square(k));
  Eigen::VectorXd row(run.terms.columns());
  run.terms.fill(0, row.data());
  CHECK(row(run.terms.square_of(1) + 3) == Approx(behind.output()(0)).epsilon(1e-9));
}

TEST_CASE("each group has columns of one kind, and says which inputs are in them") {
  Run run(NonlinearTest::kPolynomial);
  // Of each input its curve, the play, the channel's curve; three products; the sum.
  REQUIRE(run.terms.groups() == 3 * 3 + 3 + 1);
  int columns = 0, of_both = 0, of_unknown = 0;
  for (int g = 0; g < run.terms.groups(); ++g) {
    columns += static_cast<int>(run.terms.columns_of_group(g).size());
    of_both += run.terms.has(g, 0) && run.terms.has(g, 1) ? 1 : 0;
    of_unknown += run.terms.has(g, 2) ? 1 : 0;
  }
  CHECK(columns == run.terms.columns());
  CHECK(of_both == 2);         // the product and the sum
  CHECK(of_unknown == 3 + 2);  // its own and its products; the model gives nothing of it
  CHECK(run.terms.kind(12) == NonlinearKind::kOutputCurve);
  CHECK(run.terms.columns_of_group(12).size() == 2);
  CHECK(run.terms.kind(1) == NonlinearKind::kHysteresis);
}

TEST_CASE("new samples allocate nothing, whatever the functions") {
  const NonlinearTest test =
      GENERATE(NonlinearTest::kPolynomial, NonlinearTest::kKernel, NonlinearTest::kRandomFeatures);
  Run run(test);
  Eigen::VectorXd row(run.terms.columns());
  const std::vector<Eigen::VectorXd> later = {moves(500), moves(530)};
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
  const std::uint64_t before = test::allocation_count();
  for (const Eigen::VectorXd& u : later) {
    run.history.push(u, none);
    run.terms.advance(run.history, 0);
    run.terms.fill(0, row.data());
  }
  CHECK(test::allocation_count() == before);
  CHECK(row.allFinite());
  CHECK(row.norm() > 0.0);
}

TEST_CASE("an input that stands still gives no columns") {
  RegressionHistory history(kShape, kDepth);
  NonlinearTerms terms(model(), 0, 0.9, NonlinearTest::kPolynomial, 10);
  for (int k = 0; k < kDepth; ++k) {
    Eigen::VectorXd u = moves(k);
    u(0) = 5.0;
    history.push(u, Eigen::VectorXd::Zero(1));
  }
  terms.begin(history, kDepth);
  for (int age = kDepth - 1; age >= 0; --age) terms.advance(history, age);
  Eigen::VectorXd row(terms.columns());
  terms.fill(0, row.data());
  CHECK(row.allFinite());
  CHECK(row(terms.square_of(0)) == 0.0);
  CHECK_THROWS_AS(NonlinearTerms(model(), 0, 0.9, NonlinearTest::kOff, 10), std::invalid_argument);
}

}  // namespace mpm::nonlinear_terms_test
