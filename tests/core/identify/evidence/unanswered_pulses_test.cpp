#include "core/identify/evidence/unanswered_pulses.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/identify/evidence/calibration.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::unanswered_pulses_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 1000, kAt = 600;
constexpr double kNoise = 0.05;

// Moves a little at every row, as a controller does, about 40.
VectorXd controller(std::uint64_t stream) {
  return 40.0 + test::autoregressive(0.1 * test::normal(stream, kRows), 0.98).array();
}

// Two inputs, two CVs that answer both, noise with a memory. What the recorder wrote is `u`, what
// the plant got is `true_u`.
Recording recorded(const MatrixXd& u, const MatrixXd& true_u, double gain_ratio = 1.0) {
  const MatrixXd moves = true_u.array() - 40.0;
  MatrixXd y(kRows, 2);
  y.col(0) = test::first_order(moves.col(0), 2.0 * gain_ratio, 10.0, 3) +
             test::first_order(moves.col(1), -1.0, 20.0) +
             test::autoregressive(kNoise * test::normal(3, kRows), 0.9);
  y.col(1) = test::first_order(moves.col(0), 0.5 * gain_ratio, 30.0, 5) +
             test::first_order(moves.col(1), 1.0, 15.0) +
             test::autoregressive(kNoise * test::normal(4, kRows), 0.9);
  return test::recording_of(u, y);
}

ModelSpec model() {
  ModelSpec spec = test::model_of({test::lag(0, 0, 2.0, 10.0, 3.0), test::lag(0, 1, -1.0, 20.0),
                                   test::lag(1, 0, 0.5, 30.0, 5.0), test::lag(1, 1, 1.0, 15.0)},
                                  2, 2);
  spec.input_origin.setConstant(40.0);
  return spec;
}

MatrixXd inputs() {
  MatrixXd u(kRows, 2);
  u << controller(1), controller(2);
  return u;
}

std::vector<Pulse> none_of(const Recording& recording) {
  const std::vector<Pulse> pulses = short_pulses(recording);
  return unanswered(model(), without(recording, pulses), pulses);
}

}  // namespace

TEST_CASE("what moves, steps or rests has no short pulses") {
  MatrixXd u = inputs();
  CHECK(short_pulses(test::recording_of(u, u)).empty());
  u.col(0).tail(400).array() += 20.0;                         // a step
  u.col(1).segment(300, kLongestGlitch + 1).array() += 20.0;  // a pulse that is not so short
  CHECK(short_pulses(test::recording_of(u, u)).empty());
  u.col(0) = test::telegraph(5, kRows, 1);  // nothing but pulses
  u.col(1).setZero();
  for (Index k = 10; k < kRows; k += 50) u(k, 1) = 5.0;  // all that it ever does
  CHECK(short_pulses(test::recording_of(u, u)).empty());
}

TEST_CASE("a short pulse is found with its value, whatever is unknown about it, in its own run") {
  MatrixXd u = inputs();
  u(kAt - 1, 0) = std::numeric_limits<double>::quiet_NaN();
  u(kAt, 0) = 95.0;
  u(kAt + 1, 0) = 80.0;
  const std::vector<Pulse> pulses = short_pulses(test::recording_of(u, u));
  REQUIRE(pulses.size() == 1);
  CHECK(pulses[0] == Pulse{0, kAt, 2, 95.0, u(kAt - 2, 0)});
  const Recording unknown = without(test::recording_of(u, u), pulses);
  CHECK(unknown.inputs.array().isFinite().count() == u.size() - 3);
  Recording cut = test::recording_of(u, u);
  cut.borders = {{kAt + 1, 0.0}};
  CHECK(short_pulses(cut).empty());  // nobody knows what came after it
}

// Sizes within the range of the input and beyond it. The answer to 5 of a gain of 2 and a lag of
// ten samples, e^-0.1 from row to row, is its first row of 5 * 2 * (1 - e^-0.1) = 0.95 for a noise
// whose memory is as long: 19 s.d. of 0.05, and twelve are asked for.
TEST_CASE("a pulse that only the recorder saw is told from one that the plant answered") {
  const double size = GENERATE(5.0, -5.0, 10.0, 55.0);
  const double gain_ratio = GENERATE(1.0, 0.5, 2.0);
  CAPTURE(size, gain_ratio);
  for (Index row = 200; row < kRows - 100; row += 100) {
    MatrixXd u = inputs();
    MatrixXd with = u;
    with(row, 0) += size;
    CAPTURE(row);
    REQUIRE(short_pulses(recorded(with, u)).size() == 1);
    CHECK(none_of(recorded(with, u, gain_ratio)).size() == 1);
    CHECK(none_of(recorded(with, with, gain_ratio)).empty());
  }
}

TEST_CASE("what no CV would show is no pulse that the plant did not see") {
  const MatrixXd u = inputs();
  MatrixXd with = u;
  with(kAt, 0) += 20.0;
  const std::vector<Pulse> pulses = short_pulses(recorded(with, u));
  REQUIRE(pulses.size() == 1);
  ModelSpec others = model();  // without the input's channels
  std::erase_if(others.channels, [](const ChannelSpec& channel) { return channel.input == 0; });
  CHECK(unanswered(others, without(recorded(with, u), pulses), pulses).empty());
  Recording unknown = recorded(with, u);
  unknown.cvs.middleRows(kAt, 200).setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(unanswered(model(), without(unknown, pulses), pulses).empty());
}

}  // namespace mpm::unanswered_pulses_test
