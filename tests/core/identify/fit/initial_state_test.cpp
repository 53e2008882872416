#include "core/identify/fit/initial_state.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd decay(Index rows, double size, double time_constant) {
  return VectorXd::NullaryExpr(
      rows, [&](Index k) { return size * std::exp(-static_cast<double>(k) / time_constant); });
}

/// Sum of e^{-2 k / T} over k = 0 .. rows - 1: a geometric series.
double squares(Index rows, double time_constant) {
  const double ratio = std::exp(-2.0 / time_constant);
  return (1.0 - std::pow(ratio, static_cast<double>(rows))) / (1.0 - ratio);
}

// By hand: 10, 11 and 30 s every 2 s are 5, 5.5 and 15 samples; 5.5 is within a fifth of 5.
TEST_CASE("decays are the shortest, the middle and the longest time constant, if they differ") {
  ModelSpec model = test::model_of({{0, 0, TransferFunction{1.0, {30.0, 10.0}, 0, 0, false}, {}},
                                    test::lag(0, 1, 2.0, 11.0),
                                    test::lag(1, 0, 1.0, 500.0)},
                                   2, 2);
  model.sample_time_s = 2.0;
  CHECK(decay_times(model, 0) == std::vector<double>{5.0, 15.0});
  CHECK(decay_times(model, 1) == std::vector<double>{250.0});
  std::get<TransferFunction>(model.channels[1].dynamics).time_constants_s = {14.0};
  CHECK(decay_times(model, 0) == std::vector<double>{5.0, 7.0, 15.0});
  model.channels = {{0, 0, TankChain{{60.0, 20.0}, -1.0, -1.0, {}, 0.0, 0.0}, {}}};
  CHECK(decay_times(model, 0) == std::vector<double>{10.0, 30.0});
  CHECK(decay_times(model, 1).empty());
}

TEST_CASE("the first error is the root mean square of the first five known ones") {
  VectorXd measured(8);
  measured << 1.0, 2.0, std::numeric_limits<double>::quiet_NaN(), 2.0, 0.0, 4.0, 50.0, 50.0;
  CHECK(first_error(VectorXd::Zero(8), measured) == Approx(std::sqrt((1 + 4 + 4 + 0 + 16) / 5.0)));
  CHECK(first_error(VectorXd::Zero(1), VectorXd::Constant(1, std::nan(""))) == 0.0);
}

// Ridge regression on one decay d with prior variance 1: size = sum d e / (1 + sum d^2), and where
// e = c d that is c S / (1 + S).
TEST_CASE("a wrong first state is added as it dies out") {
  const double c = 3.0, time_constant = 40.0;
  const Index rows = 400;  // 40 rows are fitted: one time constant
  const double s = squares(40, time_constant);
  const VectorXd simulated = test::white(1, rows);
  const VectorXd measured = simulated + decay(rows, c, time_constant);
  const VectorXd started = start_on_data(simulated, measured, {time_constant});
  CHECK((started - simulated).isApprox(decay(rows, c * s / (1.0 + s), time_constant), 1e-10));

  // A quarter of few rows; 20 rows where the decay is shorter.
  const double few = squares(15, time_constant), shorter = squares(20, 2.0);
  CHECK(start_on_data(VectorXd::Zero(60), decay(60, c, time_constant), {time_constant})(0) ==
        Approx(c * few / (1.0 + few)).epsilon(1e-10));
  CHECK(start_on_data(VectorXd::Zero(400), decay(400, c, 2.0), {2.0})(0) ==
        Approx(c * shorter / (1.0 + shorter)).epsilon(1e-10));
}

// The same sums without the rows that are not known.
TEST_CASE("a first state is fitted to the rows that are known") {
  const double c = 2.0, time_constant = 30.0;
  VectorXd measured = decay(400, c, time_constant);
  double s = 0.0;
  for (Index k = 0; k < 30; ++k) {
    if (k >= 3 && k < 9) measured(k) = std::nan("");
    if (std::isfinite(measured(k))) s += std::pow(measured(k) / c, 2);
  }
  const VectorXd started = start_on_data(VectorXd::Zero(400), measured, {time_constant});
  CHECK(started.isApprox(decay(400, c * s / (1.0 + s), time_constant), 1e-10));
}

TEST_CASE("nothing is added where nothing is off, nothing dies out, or hardly a row is known") {
  const VectorXd simulated = test::white(2, 200);
  CHECK(start_on_data(simulated, simulated, {10.0}) == simulated);
  CHECK(start_on_data(simulated, VectorXd::Zero(200), {}) == simulated);
  const VectorXd few = simulated.head(16);
  CHECK(start_on_data(few, VectorXd::Zero(16), {10.0}) == few);
}

}  // namespace
}  // namespace mpm
