#include "core/identification/identification.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "core/identification/test_plan.hpp"
#include "tests/core/identification/loop.hpp"
#include "tests/core/oracle.hpp"

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const ChannelAnswer& answer_of(const Identification& found, int cv, int input) {
  for (const ChannelAnswer& answer : found.channels)
    if (answer.cv == cv && answer.input == input) return answer;
  throw std::logic_error("no such channel");
}

/// Three inputs moved from outside, two CVs; what is hidden is not in `identify`'s sight.
Recording open_loop(Index rows, std::uint64_t seed) {
  MatrixXd inputs(rows, 3), cvs(rows, 2);
  inputs << telegraph(seed + 1, rows, 17), telegraph(seed + 2, rows, 23),
      telegraph(seed + 3, rows, 31);
  cvs.col(0) = first_order(inputs.col(0), 2.0, 12.0, 4) + first_order(inputs.col(2), -0.5, 30.0) +
               autoregressive(0.05 * white(seed + 4, rows), 0.9);
  cvs.col(1) =
      first_order(inputs.col(1), 1.5, 8.0, 1) + autoregressive(0.05 * white(seed + 5, rows), 0.7);
  inputs.col(0).array() += 40.0;
  cvs.col(1).array() += 100.0;
  return recording_of(inputs, cvs);
}

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

TEST_CASE("identify is right in closed loop, as an independent fit of the same data is") {
  // Expected numbers: tests/oracles/identification.py, scipy's least squares.
  const Identification found = identify(Loop().run(1500), {});
  const auto expected = read_oracle("identification.json");
  int input = 0;
  for (const char* name : {"first", "second"}) {
    CAPTURE(name);
    const ChannelAnswer& answer = answer_of(found, 0, input++);
    REQUIRE(answer.left_out == LeftOut::kIdentified);
    const auto close = [&](const char* number, double value) {
      const double sd = expected[name][number]["sd"];
      CAPTURE(number);
      CHECK(value == Approx(double(expected[name][number]["value"])).margin(0.5 * sd));
    };
    close("gain", answer.dynamics->gain);
    close("time_constant", answer.dynamics->time_constants_s.at(0));
    close("dead_time", answer.dynamics->dead_time_s);
    const double width = (answer.gain.high - answer.gain.low) / 2.0 / 1.96;
    CHECK(width == Approx(double(expected[name]["gain"]["sd"])).epsilon(0.2));
  }
  CHECK(found.cvs[0].innovation_sd * found.cvs[0].innovation_sd ==
        Approx(double(expected["variance"])).epsilon(0.05));
  CHECK(found.feedback_p_value < 1e-3);
}

TEST_CASE("an input that only feedback moves is left out and told so") {
  Loop loop;
  loop.setpoint_moves = false;
  loop.second.gain = 0.0;
  const Identification found = identify(loop.run(2000), {});
  CHECK(answer_of(found, 0, 0).left_out == LeftOut::kOnlyFeedback);
  CHECK(found.model.channels.empty());
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

TEST_CASE("a channel with a slow tail gets its lead, one of two equal lags its second") {
  const Index rows = 4000;
  MatrixXd inputs(rows, 1), cvs(rows, 2);
  inputs << telegraph(821, rows, 60);
  // (12 s + 1) / ((4 s + 1)(20 s + 1)) = 0.5 / (4 s + 1) + 0.5 / (20 s + 1)
  cvs.col(0) = first_order(inputs.col(0), 0.5, 4.0) + first_order(inputs.col(0), 0.5, 20.0) +
               0.01 * white(822, rows);
  // 1 / (10 s + 1)^2 behind a hold: 1 - e^{-t/10} (1 + t/10), as a sum over the moves.
  cvs.col(1) = 0.01 * white(823, rows);
  for (Index j = 1; j < rows; ++j) {
    const double move = inputs(j, 0) - inputs(j - 1, 0);
    if (move == 0.0) continue;
    for (Index k = j + 1; k < rows; ++k) {
      const double t = static_cast<double>(k - j) / 10.0;
      cvs(k, 1) += move * (1.0 - std::exp(-t) * (1.0 + t));
    }
  }
  const Identification found = identify(recording_of(inputs, cvs), {});
  const ChannelAnswer& lead = answer_of(found, 0, 0);
  REQUIRE(lead.form == ChannelForm::kSecondOrderLead);
  CHECK(lead.dynamics->lead_s == Approx(12.0).epsilon(0.1));
  const ChannelAnswer& second = answer_of(found, 1, 0);
  REQUIRE(second.form == ChannelForm::kSecondOrder);
  CHECK(second.dynamics->time_constants_s[0] + second.dynamics->time_constants_s[1] ==
        Approx(20.0).epsilon(0.05));
}

TEST_CASE("an input that stands still is planned a test of its size and length") {
  Recording recording = open_loop(2000, 840);
  recording.inputs.col(1).setConstant(5.0);
  const Identification found = identify(recording, {});
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kStill);
  TestLimits limits;
  limits.inputs.resize(3);
  limits.inputs[1] = {0.0, 20.0};
  limits.cvs.resize(2);
  const std::vector<PlannedTest> plan = test_plan(found, limits, 3);
  REQUIRE(!plan.empty());
  const auto test = std::find_if(plan.begin(), plan.end(),
                                 [](const PlannedTest& each) { return each.input == 1; });
  REQUIRE(test != plan.end());
  CHECK(test->cvs == std::vector<int>{0, 1});
  CHECK(test->amplitude == Approx(1.0));  // a tenth of 20, half of it to either side
  // At least the 5 time constants of 30 s of CV 0's slowest channel.
  CHECK(test->settling_s > 100.0);
  CHECK(test->duration_s >= 4.0 * test->settling_s);
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
