#include "core/identify/fit/free_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

// What is left of a first state c dies out as c e^{-k/T}. Ridge regression on it, with prior
// variance 1, over one time constant of rows takes off c S / (1 + S), S = sum e^{-2k/T}.
TEST_CASE("a free run begins where the measurements do and then goes by its inputs alone") {
  const Index rows = 400;
  const double c = 5.0, time_constant = 50.0;
  const VectorXd u = test::telegraph(1, rows, 10);
  const VectorXd decay = VectorXd::NullaryExpr(
      rows, [&](Index k) { return std::exp(-static_cast<double>(k) / time_constant); });
  const double ratio = std::exp(-2.0 / time_constant);
  const double s = (1.0 - std::pow(ratio, 50.0)) / (1.0 - ratio);
  const VectorXd rest = test::first_order(u, 2.0, time_constant);
  MatrixXd measured(rows, 2);
  measured << rest + c * decay, test::first_order(u, -1.0, 8.0);
  const Recording recording = test::recording_of(u, measured);
  const ModelSpec model =
      test::model_of({lag(0, 0, 2.0, time_constant), lag(1, 0, -1.0, 8.0)}, 1, 2);
  Simulator simulator(recording);
  const VectorXd run = free_run(simulator, model, 0);
  CHECK(run.isApprox(rest + c * s / (1.0 + s) * decay, 1e-9));
  CHECK(run(0) == Approx(c).epsilon(0.05));
  const MatrixXd all = free_runs(simulator, model);
  CHECK(all.col(0) == run);
  CHECK(all.col(1).isApprox(measured.col(1), 1e-9));
}

// The errors of a run whose first state is right are its level, whatever the noise.
TEST_CASE("of several runs each is at its own level") {
  const Index rows = 300;
  const VectorXd u = test::telegraph(1, rows, 10), noise = 0.1 * test::white(5, rows);
  const VectorXd rest = test::first_order(u, 2.0, 20.0);
  const Recording low = test::recording_of(u, (rest + noise).array() - 3.0);
  const Recording high = test::recording_of(u, (rest - noise).array() + 5.0);
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 20.0)}, 1, 1);
  const Recording both = joined({low, high});
  Simulator simulator(both);
  const VectorXd errors = both.cvs.col(0) - free_run(simulator, model, 0);
  CHECK(errors.head(rows).mean() == Approx(0.0).margin(1e-12));
  CHECK(errors.tail(rows).mean() == Approx(0.0).margin(1e-12));
  // The first rows are noise about the level, so the first state hardly moves.
  CHECK(errors.norm() / std::sqrt(2.0 * rows) == Approx(0.1).epsilon(0.1));
  Simulator alone(low);
  CHECK(std::abs((low.cvs.col(0) - free_run(alone, model, 0)).tail(100).mean()) > 2.0);
}

}  // namespace
}  // namespace mpm
