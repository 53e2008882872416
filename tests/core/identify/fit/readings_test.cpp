#include "core/identify/fit/readings.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/simulator.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::readings_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

constexpr Index kMany = 6000;

// The first CV is measured at every sample, the second one is an analyser's.
ModelSpec model() { return test::model_of({lag(0, 0, 1.0, 20.0), lag(1, 0, 2.0, 10.0)}, 1, 2); }

void read_every(Index every, Index offset, Eigen::Ref<VectorXd> cv) {
  for (Index k = offset; k < cv.size(); ++k) cv(k) = cv(k - (k - offset) % every);
}

/// Without noise; the second one's n-th reading is in the rows from ceil(first + n every) on.
Recording analysed(double first, double every) {
  const VectorXd u = test::telegraph(1, kMany, 12);
  MatrixXd cvs(kMany, 2);
  cvs.col(0) = test::first_order(u, 1.0, 20.0);
  const VectorXd exact = test::first_order(u, 2.0, 10.0);
  cvs.col(1) = exact;
  for (Index n = 0;; ++n) {
    const auto from = static_cast<Index>(std::ceil(first + static_cast<double>(n) * every));
    const auto to = static_cast<Index>(std::ceil(first + static_cast<double>(n + 1) * every));
    if (from >= kMany) break;
    for (Index k = from; k < std::min(to, kMany); ++k) cvs(k, 1) = exact(from);
  }
  return test::recording_of(u, cvs);
}

}  // namespace

// Closed form: without noise, at every 6th row from the third on.
TEST_CASE("at its readings a CV is what the model says at its own sample time") {
  const VectorXd u = test::telegraph(1, kMany, 12);
  MatrixXd cvs(kMany, 2);
  cvs.col(0) = test::first_order(u, 1.0, 20.0);
  cvs.col(1) = test::first_order(u, 2.0, 10.0);
  read_every(6, 2, cvs.col(1));
  const Recording recording = test::recording_of(u, cvs);
  const Readings readings{6, {2}, {1}};
  const Recording rows = of_readings(model(), recording, readings);
  Simulator simulator(rows);
  const VectorXd simulated = simulator.cv(*of_readings(model(), readings), 0);
  const Recording as_read = averaged(of_cvs(recording, {1}), 6, {2});
  CHECK((simulated - rows.cvs.col(0)).lpNorm<Eigen::Infinity>() < 1e-9);
  CHECK((simulated - as_read.cvs.col(0)).lpNorm<Eigen::Infinity>() > 0.05);
}

// Closed form: each row is what the model gives at a row of the recording, whichever that is.
TEST_CASE("in a cycle of no whole number of rows each reading is taken where it came") {
  const Recording recording = analysed(3.2, 7.3);
  const std::vector<Readings> all = readings_of(recording);
  REQUIRE(all.size() == 2);
  CHECK(all[0].cvs == std::vector{0});
  CHECK(all[1].cvs == std::vector{1});
  CHECK(all[1].every == Approx(7.3).epsilon(1e-4));
  const Recording rows = averaged(of_cvs(recording, {1}), all[1].every, all[1].offsets);
  CHECK(rows.samples() >= static_cast<Index>(kMany / 7.3) - 2);
  CHECK(rows.sample_time_s == Approx(7.3 * recording.sample_time_s).epsilon(1e-4));
  // Every reading once, none of them twice, but where the row is a matter of rounding.
  Index repeated = 0;
  for (Index k = 1; k < rows.samples(); ++k) repeated += rows.cvs(k, 0) == rows.cvs(k - 1, 0);
  CHECK(repeated <= rows.samples() / 200);
  // The mean of the inputs over all rows is that over all that were averaged.
  const auto last = static_cast<Index>(all[1].offsets[0] +
                                       static_cast<double>(rows.samples()) * all[1].every + 1e-6);
  const auto first = static_cast<Index>(all[1].offsets[0]);
  CHECK(rows.inputs.mean() ==
        Approx(recording.inputs.middleRows(first, last - first).mean()).margin(0.02));
}

}  // namespace mpm::readings_test
