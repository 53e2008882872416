#include "core/identify/fit/whitening.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd second_order(const VectorXd& white, double a1, double a2) {
  VectorXd x = white;
  for (Index k = 0; k < x.size(); ++k) {
    if (k >= 1) x(k) += a1 * x(k - 1);
    if (k >= 2) x(k) += a2 * x(k - 2);
  }
  return x;
}

// By hand: A(q) = 1 - 0.5 q^-1 + 0.25 q^-2 on 8, 4, 2, 6.
TEST_CASE("whitening takes from each row its past, and is silent while it has none") {
  Whitening whitening;
  whitening.coefficients = Eigen::Vector2d(0.5, -0.25);
  const VectorXd white = whitening.apply(Eigen::Vector4d(8.0, 4.0, 2.0, 6.0));
  CHECK(white == Eigen::Vector4d(0.0, 0.0, 2.0, 6.0));
  whitening.coefficients.resize(0);
  CHECK(whitening.apply(Eigen::Vector2d(3.0, 5.0)) == Eigen::Vector2d(3.0, 5.0));
}

// Without noise every row says the same: a decaying swing is exactly its own past.
TEST_CASE("an exact autoregression gives back its coefficients, whatever its weights") {
  VectorXd pulse = VectorXd::Zero(60);
  pulse(0) = 1.0;
  VectorXd swing = second_order(pulse, 1.6, -0.8).tail(58);
  VectorXd weights = VectorXd::NullaryExpr(58, [](Index k) { return k % 3 == 0 ? 1.0 : 2.5; });
  const NoiseModel order_2{2, 0.0};
  const Whitening exact = fit_whitening(swing, weights, order_2);
  CHECK(exact.coefficients(0) == Approx(1.6).epsilon(1e-10));
  CHECK(exact.coefficients(1) == Approx(-0.8).epsilon(1e-10));
  CHECK(exact.apply(swing).norm() < 1e-10);

  swing(30) += 7.0;  // told by its weights to be wrong, and so are the rows that have it as past
  weights.segment(30, 3).setZero();
  const Whitening robust = fit_whitening(swing, weights, order_2);
  CHECK(robust.coefficients(0) == Approx(1.6).epsilon(1e-10));
  CHECK(robust.coefficients(1) == Approx(-0.8).epsilon(1e-10));
}

// Fitted to a swing of one frequency, orders beyond two are any: the fit stays finite and exact.
TEST_CASE("more past than there is to say has coefficients all the same") {
  VectorXd pulse = VectorXd::Zero(400);
  pulse(0) = 1.0;
  const VectorXd swing = second_order(pulse, 1.99, -0.9999).tail(398);
  const Whitening fitted = fit_whitening(swing, VectorXd::Ones(398), {6, 0.0});
  REQUIRE(fitted.coefficients.allFinite());
  CHECK(fitted.coefficients.norm() < 10.0);
  CHECK(fitted.apply(swing).norm() < 1e-9 * swing.norm());
}

// Rows before a whole past are silent, and so are those after a border; the others are as summed by
// hand, in any number of them.
TEST_CASE("whitening sums as many rows as there are") {
  for (const Index rows : {1, 3, 4, 5, 40, 67, 300}) {
    CAPTURE(rows);
    Whitening whitening;
    whitening.coefficients = test::white(5, 4);
    const VectorXd x = test::white(6, rows);
    VectorXd expected = VectorXd::Zero(rows);
    for (Index k = 4; k < rows; ++k) {
      expected(k) = x(k);
      for (Index l = 1; l <= 4; ++l) expected(k) -= whitening.coefficients(l - 1) * x(k - l);
    }
    CHECK((whitening.apply(x) - expected).norm() <= 1e-14 * x.norm());
  }
}

// The asymptotic covariance of a fitted autoregression is (A A' - B B') / n with A and B triangular
// of its true coefficients (Gohberg and Semencul 1972), so none varies by more than their squares.
TEST_CASE("a longer autoregression finds the order by itself") {
  const Index rows = 20000;
  const auto count = static_cast<double>(rows);
  const VectorXd noise = second_order(test::white(1, rows), 1.2, -0.5);
  const Whitening fitted = fit_whitening(noise, VectorXd::Ones(rows), {8, 0.0});
  REQUIRE(fitted.coefficients.size() == 8);
  VectorXd truth = VectorXd::Zero(8);
  truth.head(2) << 1.2, -0.5;
  const double sd = std::sqrt((1.0 + truth.squaredNorm()) / count);
  CHECK((fitted.coefficients - truth).cwiseAbs().maxCoeff() < 4.0 * sd);
  // The square of a uniform variable of variance 1 has the variance 9 / 5 - 1.
  CHECK(fitted.apply(noise).squaredNorm() / count ==
        Approx(1.0).margin(4.0 * std::sqrt(0.8 / count)));
}

TEST_CASE("a bounded noise model stays between none and its bound") {
  const Index rows = 5000;
  const NoiseModel bounded{1, 0.9};
  const auto coefficient = [&](double a) {
    return fit_whitening(test::autoregressive(test::white(2, rows), a), VectorXd::Ones(rows),
                         bounded)
        .coefficients(0);
  };
  CHECK(coefficient(0.99) == 0.9);
  CHECK(coefficient(-0.5) == 0.0);
  CHECK(coefficient(0.6) == Approx(0.6).margin(4.0 * 0.8 / std::sqrt(5000.0)));
}

TEST_CASE("too few rows, or none that move, have no noise model") {
  const NoiseModel order_8{8, 0.0};
  CHECK(fit_whitening(test::white(3, 24), VectorXd::Ones(24), order_8).coefficients.isZero(0.0));
  CHECK(fit_whitening(VectorXd::Zero(500), VectorXd::Ones(500), order_8).coefficients.isZero(0.0));
}

TEST_CASE("nothing is whitened across a border") {
  Whitening filter;
  filter.coefficients.resize(2);
  filter.coefficients << 0.7, -0.2;
  const VectorXd first = test::white(7, 30), second = test::white(8, 20).array() + 100.0;
  VectorXd both(50);
  both << first, second;
  Whitening bordered = filter;
  bordered.borders = {{30, 0.0}};
  CHECK(bordered.apply(both).head(30) == filter.apply(first));
  CHECK(bordered.apply(both).tail(20) == filter.apply(second));
}

}  // namespace
}  // namespace mpm
