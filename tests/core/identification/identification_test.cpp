#include "core/identification/identification.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void check_covers(const Interval95& interval, double truth, double room) {
  const double middle = 0.5 * (interval.low + interval.high), half = interval.high - middle;
  CHECK(std::abs(truth - middle) < room * half);
}

}  // namespace

TEST_CASE("identify finds the channels that are there, their numbers, and no others") {
  // 95 % intervals: all of them are to hold the truth within twice their width.
  const Identification found = identify(open_loop(3000, 700), {});
  CHECK(found.model.channels.size() == 3);
  struct Hidden {
    int cv, input;
    double gain, time_constant, dead_time;
  };
  for (const Hidden& hidden :
       {Hidden{0, 0, 2.0, 12.0, 4.0}, Hidden{0, 2, -0.5, 30.0, 0.0}, Hidden{1, 1, 1.5, 8.0, 1.0}}) {
    CAPTURE(hidden.cv, hidden.input);
    const ChannelAnswer& answer = answer_of(found, hidden.cv, hidden.input);
    REQUIRE(answer.left_out == LeftOut::kIdentified);
    CHECK(answer.form == ChannelForm::kFirstOrder);
    check_covers(answer.gain, hidden.gain, 2.0);
    REQUIRE(answer.time_constants.size() == 1);
    check_covers(answer.time_constants[0], hidden.time_constant, 2.0);
    CHECK(answer.dynamics->dead_time_s == Approx(hidden.dead_time).margin(1.0));
    CHECK(answer.dynamics->gain == Approx(hidden.gain).epsilon(0.05));
    // The band ends where the gain is known as well as its interval says.
    CHECK(answer.step.back() == Approx(answer.dynamics->gain).epsilon(0.02));
  }
  for (const auto& [cv, input] : {std::pair{0, 1}, {1, 0}, {1, 2}})
    CHECK(answer_of(found, cv, input).left_out == LeftOut::kNoRelation);
  // Levels: input 0 rests at 40, CV 1 at 100 with its input at 0.
  CHECK(found.model.input_origin(0) == Approx(40.0).margin(0.5));
  CHECK(found.model.output_origin(1) ==
        Approx(100.0 + 1.5 * found.model.input_origin(1)).margin(0.1));
  CHECK(found.feedback_p_value > 1e-3);
}

// 1 in 3000 values of an input. Without it the same model, number by number.
TEST_CASE("a value of an input that only the recorder saw changes no number of a model") {
  Recording recording = open_loop(3000, 700);
  recording.inputs(2000, 0) += 60.0;
  const Identification found = identify(recording, {});
  REQUIRE(found.unanswered.size() == 1);
  CHECK(found.unanswered[0].row == 2000);
  recording.inputs(2000, 0) = std::numeric_limits<double>::quiet_NaN();
  const Identification unknown = identify(recording, {});
  CHECK(unknown.unanswered.empty());
  REQUIRE(found.channels.size() == unknown.channels.size());
  for (std::size_t c = 0; c < found.channels.size(); ++c) {
    CHECK(found.channels[c].left_out == unknown.channels[c].left_out);
    CHECK(found.channels[c].gain.low == unknown.channels[c].gain.low);
    CHECK(found.channels[c].dead_time_s.high == unknown.channels[c].dead_time_s.high);
  }
}

TEST_CASE("one slow step in open loop gives the gain that the free run asks for") {
  // A first order of gain 0.33, 126 samples, 15 of dead time, up and back again, read to 0.3 beside
  // a slow disturbance: 382 rows, the last 157 of which only fall. With a noise model the gain is
  // 11 % too large, for what is slow may as well be the noise.
  const Index rows = 382;
  VectorXd u(rows);
  for (Index k = 0; k < rows; ++k) u(k) = k < 25 ? 0.0 : k < 225 ? 150.0 : 10.0;
  VectorXd y = first_order(u, 0.33, 126.0, 15) + 0.2 * autoregressive(normal(2, rows), 0.95);
  for (double& value : y) value = 0.3 * std::round(value / 0.3);
  const Identification found = identify(recording_of(u, y), {});
  const ChannelAnswer& answer = answer_of(found, 0, 0);
  REQUIRE(answer.left_out == LeftOut::kIdentified);
  CHECK(answer.dynamics->gain == Approx(0.33).epsilon(0.06));
  check_covers(answer.gain, 0.33, 1.0);
}

TEST_CASE("what wanders beside inputs that do nothing gets no channel of a size nobody knows") {
  for (const std::uint64_t seed : {100U, 115U, 116U, 121U, 148U}) {
    CAPTURE(seed);
    const Index rows = 430;
    MatrixXd u(rows, 2);
    u << telegraph(seed * 7, rows, 60), telegraph(seed * 7 + 1, rows, 35);
    const VectorXd y = autoregressive(autoregressive(normal(seed * 7 + 2, rows), 0.99), 0.9);
    CHECK(identify(recording_of(u, y), {}).model.channels.empty());
  }
}

TEST_CASE(
    "what answers within its own sample is identified where the user says that nobody controls") {
  // y(k) sees half of u(k): what a controller that moves u(k) by y(k) would look like.
  const Index rows = 1500;
  const VectorXd u = autoregressive(normal(31, rows), 0.97);
  VectorXd y = first_order(u, -2.0, 6.0) + 0.5 * autoregressive(normal(32, rows), 0.6);
  for (Index k = 0; k < rows; ++k) y(k) -= 1.0 * u(k);
  IdentificationSettings settings;
  CHECK(answer_of(identify(recording_of(u, y), settings), 0, 0).left_out == LeftOut::kOnlyFeedback);
  settings.open_loop = true;
  const Identification found = identify(recording_of(u, y), settings);
  REQUIRE(answer_of(found, 0, 0).left_out == LeftOut::kIdentified);
  CHECK(answer_of(found, 0, 0).dynamics->gain == Approx(-3.0).epsilon(0.1));
}

TEST_CASE("an input that only feedback moves is left out and told so") {
  Loop loop;
  loop.setpoint_moves = false;
  loop.second.gain = 0.0;
  const Identification found = identify(loop.run(2000), {});
  CHECK(answer_of(found, 0, 0).left_out == LeftOut::kOnlyFeedback);
  CHECK(found.model.channels.empty());
}

// A historian's averages, or time stamps at the end of an interval.
TEST_CASE("a CV that answers within the row is told so, and not taken for feedback") {
  constexpr Eigen::Index kRows = 1500;
  Eigen::MatrixXd inputs(kRows, 2), cvs(kRows, 1);
  inputs << white(730, kRows), white(731, kRows);
  const Eigen::VectorXd answer =
      first_order(inputs.col(0), 2.0, 8.0) + first_order(inputs.col(1), -1.0, 3.0);
  cvs.col(0) = autoregressive(0.1 * white(732, kRows), 0.8);
  cvs.col(0).head(kRows - 1) += answer.tail(kRows - 1);
  const Identification late = identify(recording_of(inputs, cvs), {});
  CHECK(late.within_row);
  CHECK(answer_of(late, 0, 0).left_out != LeftOut::kOnlyFeedback);
  CHECK(answer_of(late, 0, 1).left_out != LeftOut::kOnlyFeedback);
  // As advised: with the inputs moved up by a row all is well.
  const Identification moved =
      identify(recording_of(inputs.bottomRows(kRows - 1), cvs.topRows(kRows - 1)), {});
  CHECK_FALSE(moved.within_row);
  CHECK(answer_of(moved, 0, 0).gain.low < 2.0);
  CHECK(answer_of(moved, 0, 0).gain.high > 2.0);
  CHECK(moved.cvs[0].unseen_rmse < 1.2 * 0.1 / std::sqrt(1.0 - 0.8 * 0.8));  // the noise
  CHECK_FALSE(identify(Loop().run(1500), {}).within_row);
}

// Time constant half of the record: the slope is known well, the gain is not.
TEST_CASE("a slow channel of vague gain stays where predictions are worse without it", "[trials]") {
  constexpr Eigen::Index kRows = 1500;
  int kept = 0;
  for (std::uint64_t seed = 740; seed < 780; seed += 4) {
    Eigen::MatrixXd inputs(kRows, 2), cvs(kRows, 1);
    inputs << telegraph(seed, kRows, 60), telegraph(seed + 1, kRows, 20);
    cvs.col(0) = first_order(inputs.col(0), 10.0, 700.0) + first_order(inputs.col(1), 0.5, 10.0) +
                 autoregressive(0.03 * white(seed + 2, kRows), 0.9);
    const Identification found = identify(recording_of(inputs, cvs), {});
    kept += answer_of(found, 0, 0).left_out == LeftOut::kIdentified ? 1 : 0;
    CHECK(found.cvs[0].unseen_rmse < 0.6 * found.cvs[0].unseen_spread);
  }
  CHECK(kept == 10);
}

// 1 / (5 s + 1) - 1.5 / (60 s + 1), in samples: up at first, in the end down by half as much.
TEST_CASE("an answer that turns back is not taken for a late one") {
  constexpr Eigen::Index kRows = 3000;
  for (std::uint64_t seed = 800; seed < 840; seed += 4) {
    Eigen::MatrixXd inputs(kRows, 1), cvs(kRows, 1);
    inputs.col(0) = telegraph(seed, kRows, 40);
    cvs.col(0) = first_order(inputs.col(0), 1.0, 5.0) + first_order(inputs.col(0), -1.5, 60.0) +
                 autoregressive(0.05 * white(seed + 1, kRows), 0.8);
    const ChannelAnswer answer = answer_of(identify(recording_of(inputs, cvs), {}), 0, 0);
    CAPTURE(seed);
    CHECK(answer.left_out == LeftOut::kIdentified);
    CHECK(answer.form == ChannelForm::kSecondOrderLead);
    CHECK(answer.dynamics->gain == Approx(-0.5).margin(0.1));
    CHECK(answer.dynamics->lead_s < -50.0);  // of the true one -105: -0.5 (1 - 105 s) / ..
    CHECK(answer.dynamics->dead_time_s < 2.0);
  }
}

TEST_CASE("hints are kept") {
  const Recording recording = open_loop(2000, 720);
  IdentificationSettings settings;
  settings.hints = {{0, 0, false, -1, {}}, {0, 2, true, 0, {}}, {1, 1, false, 1, 3.0}};
  const Identification found = identify(recording, settings);
  // The data say +2.
  CHECK(answer_of(found, 0, 0).left_out == LeftOut::kWrongSign);
  CHECK(answer_of(found, 0, 2).left_out == LeftOut::kGivenNone);
  REQUIRE(answer_of(found, 1, 1).left_out == LeftOut::kIdentified);
  CHECK(answer_of(found, 1, 1).dynamics->dead_time_s == 3.0);
}

TEST_CASE("runs at levels of their own are one model") {
  Recording one = open_loop(900, 740), two = open_loop(900, 760), three = open_loop(900, 780);
  two.cvs.array() += 7.0;
  three.cvs.array() -= 20.0;
  const Identification found = identify(joined({one, two, three}), {});
  CHECK(found.model.channels.size() == 3);
  CHECK(answer_of(found, 0, 0).dynamics->gain == Approx(2.0).epsilon(0.05));
}

TEST_CASE("a level that integrates is told from one that settles, with the inputs that hold it") {
  const Index rows = 3000;
  MatrixXd inputs(rows, 2), cvs(rows, 1);
  inputs << telegraph(801, rows, 20), telegraph(802, rows, 33);
  const VectorXd noise = autoregressive(0.05 * white(803, rows), 0.8);
  double level = 0.0;
  for (Index k = 0; k < rows; ++k) {
    cvs(k, 0) = level + noise(k);
    // Rests where the first input is 0.1: gain 0.05 per sample, one sample of dead time.
    level += 0.05 * ((k > 0 ? inputs(k - 1, 0) : 0.0) - 0.1);
  }
  const Identification found = identify(recording_of(inputs, cvs), {});
  REQUIRE(answer_of(found, 0, 0).left_out == LeftOut::kIdentified);
  CHECK(answer_of(found, 0, 0).dynamics->integrating);
  CHECK(answer_of(found, 0, 0).dynamics->gain == Approx(0.05).epsilon(0.05));
  CHECK(answer_of(found, 0, 1).left_out != LeftOut::kIdentified);
  CHECK(found.model.input_origin(0) == Approx(0.1).margin(0.02));
}

TEST_CASE("a controlled level integrates all its flows, however little each one shows it",
          "[trials]") {
  const Index rows = 8000;
  MatrixXd inputs(rows, 3), cvs(rows, 1);
  const VectorXd feed = 2.0 * autoregressive(0.1 * white(811, rows), 0.995);
  const VectorXd steam = telegraph(812, rows, 60), setpoint = 8.0 * telegraph(813, rows, 400);
  const VectorXd noise = 0.1 * white(814, rows),
                 drift = autoregressive(0.02 * white(815, rows), 0.99);
  double level = 0.0, integral = 0.0;
  for (Index k = 0; k < rows; ++k) {
    cvs(k, 0) = level + drift(k) + noise(k);
    const double error = cvs(k, 0) - setpoint(k);
    integral += error * 15.0 / 3000.0;
    inputs.row(k) << steam(k), 0.8 * (error + integral), feed(k);
    level += 0.0225 * (-inputs(k, 0) - inputs(k, 1) + inputs(k, 2));
  }
  const Identification found = identify(recording_of(inputs, cvs), {});
  for (int input = 0; input < 3; ++input) {
    CAPTURE(input);
    const ChannelAnswer& answer = answer_of(found, 0, input);
    REQUIRE(answer.left_out == LeftOut::kIdentified);
    CHECK(answer.dynamics->integrating);
    CHECK(answer.dynamics->gain == Approx(input == 2 ? 0.0225 : -0.0225).epsilon(0.1));
  }
}

TEST_CASE("what an analyser holds between two readings is not taken for dead time") {
  Recording recording = open_loop(3000, 700);
  for (Index k = 0; k < 3000; ++k) recording.cvs(k, 0) = recording.cvs(k - k % 10, 0);
  const Identification found = identify(recording, {});
  for (int input = 0; input < 3; ++input)
    CHECK(answer_of(found, 0, input).left_out == LeftOut::kReadSeldom);
  CHECK(found.cvs[0].read_every == 10);
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kIdentified);
}

TEST_CASE("the same data give the same bits on any number of threads") {
  const Recording recording = open_loop(1200, 860);
  IdentificationSettings many;
  many.threads = 4;
  const Identification one = identify(recording, {}), four = identify(recording, many);
  REQUIRE(one.channels.size() == four.channels.size());
  for (std::size_t c = 0; c < one.channels.size(); ++c) {
    CHECK(one.channels[c].gain.low == four.channels[c].gain.low);
    CHECK(one.channels[c].p_value == four.channels[c].p_value);
  }
}

TEST_CASE("what is hardly there is refused, never a crash") {
  Recording recording = open_loop(60, 880);
  CHECK(identify(recording, {}).channels.size() == 6);
  recording = open_loop(500, 881);
  recording.cvs.col(0).setConstant(std::nan(""));
  recording.inputs.col(2).setConstant(std::nan(""));
  const Identification found = identify(recording, {});
  CHECK(answer_of(found, 0, 0).left_out != LeftOut::kIdentified);
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kIdentified);
  CHECK(identify(recording_of(MatrixXd(0, 2), MatrixXd(0, 1)), {}).model.channels.empty());
}

}  // namespace mpm::test
