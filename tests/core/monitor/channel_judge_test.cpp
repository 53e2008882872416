#include "core/monitor/channel_judge.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/statistics/f_distribution.hpp"

namespace mpm::channel_judge_test {
namespace {

// One MV and one DV to one CV: each channel has half of the unit's false-alarm rate of 0.01.
struct Bench {
  Bench() : memory(2, {}), alarms(2, 0.1) {
    settings.false_alarm_rate = 0.01;
    settings.gain_error_of_interest = 0.25;
    evidence.p_value = 0.2;
    evidence.statistic = 1.2;
    evidence.numerator_freedom = 5.0;
    evidence.tests = 2;
    evidence.reference_gain = -2.0;
    evidence.gain_error = {0.1, 0.02};
    evidence.excitation_index = evidence.excitation_index_alone = 0.01;
    RowBatch batch(3, 1);
    const double whole = 1.0;
    for (int k = 0; k < 60; ++k) {
      for (int c = 0; c < 3; ++c) batch.row(0)[c] = k % (c + 2) == 0 ? 1.0 : 0.5;
      memory.take(batch, &whole, 1);
    }
  }
  ChannelStatus judge(int input = 0) const {
    ChannelJudge judge(SignalCounts{1, 1, 1, 0}, settings);
    ChannelStatus status;
    judge.judge({.input = input,
                 .bad_data = bad_data,
                 .spoilt = spoilt,
                 .overdue = overdue,
                 .memory = memory,
                 .evidence = evidence,
                 .alarms = alarms,
                 .mvs_still = mvs_still,
                 .at_limit = at_limit,
                 .confounded = confounded,
                 .confounder = confounder,
                 .peak = peak,
                 .mean_line = line,
                 .bends = bends,
                 .belief = belief},
                status);
    return status;
  }
  DerivedSettings settings;
  RegressionMemory memory;
  ChannelEvidence evidence;
  CvAlarms alarms;
  Reason bad_data = Reason::kNone;
  int spoilt = -1;
  bool overdue = false, mvs_still = false, at_limit = false, confounded = false;
  int confounder = -1;
  CorrelationPeak peak;
  double line = 0.0;
  bool bends = false;
  Belief belief;
};

TEST_CASE("the p-value decides where an error of interest would show") {
  Bench bench;
  CHECK(bench.judge().verdict == Verdict::kMatch);
  bench.evidence.p_value = 0.0049;
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  bench.evidence.p_value = 0.0051;
  CHECK(bench.judge().verdict == Verdict::kMatch);
  // F whose p, doubled for two tests, is the channel's rate.
  const double threshold = bench.judge().threshold;
  CHECK(2.0 * f_upper_tail(threshold, 5.0, bench.memory.freedom()) == Approx(0.005).epsilon(1e-9));
}

TEST_CASE("the gain error has its 95 % interval, in units of the process") {
  const ChannelStatus status = Bench().judge();
  CHECK(status.effect_size == Approx(-0.2));  // 10 % of -2
  CHECK(status.effect_low == Approx(-0.2 - 1.96 * 0.04));
  CHECK(status.effect_high == Approx(-0.2 + 1.96 * 0.04));
  CHECK(status.smallest_error == Approx(0.058));  // 5.8 s.d.
}

TEST_CASE("an error that would not show is not ruled out, and the reason is told") {
  Bench bench;
  bench.evidence.excitation_index = 0.05;  // 29 % would show
  CHECK(bench.judge().verdict == Verdict::kUndetermined);
  CHECK(bench.judge().reason == Reason::kNotExcited);
  bench.at_limit = true;
  CHECK(bench.judge().reason == Reason::kConstrained);
  bench.evidence.confounder = 1;
  CHECK(bench.judge().reason == Reason::kCollinear);
  CHECK(bench.judge().confounder == 1);
  bench.evidence.excitation_index_alone = 0.05;  // not for the other input
  CHECK(bench.judge().reason == Reason::kConstrained);
  bench.mvs_still = true;
  CHECK(bench.judge(0).reason == Reason::kControllerOff);
  CHECK(bench.judge(1).reason == Reason::kConstrained);  // a DV stands for itself
  // But for strong evidence: a tenth of the channel's rate of 0.005.
  bench.evidence.p_value = 6e-4;
  CHECK(bench.judge().verdict == Verdict::kUndetermined);
  bench.evidence.p_value = 4e-4;
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  CHECK(bench.judge().reason == Reason::kWeakExcitation);
}

TEST_CASE("that a gain varies is said of a channel whose gain would be known") {
  Bench bench;
  bench.bends = true;
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  CHECK(bench.judge().reason == Reason::kOperatingPoint);
  bench.evidence.excitation_index = 0.05;  // 29 % would show, of interest are 25 %
  CHECK(bench.judge().verdict == Verdict::kUndetermined);
}

TEST_CASE("of a CV with coarse readings only what is beyond doubt and would show is a mismatch") {
  // A readings' share of repetitions below 0.45 is no reason for doubt; above it p < 1e-6 of an
  // excited channel is asked for.
  Bench bench;
  bench.evidence.p_value = 1e-5;
  bench.belief = belief_in(0.44, 0.25);
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  bench.belief = belief_in(0.46, 0.25);
  CHECK(bench.judge().verdict == Verdict::kUndetermined);
  CHECK(bench.judge().reason == Reason::kCoarse);
  bench.evidence.p_value = 1e-7;
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  bench.evidence.excitation_index = 0.05;  // 29 % would show, of interest are 25 %
  CHECK(bench.judge().reason == Reason::kCoarse);
  bench.evidence.p_value = 0.2;  // nothing is off
  CHECK(bench.judge().reason == Reason::kNotExcited);
}

TEST_CASE("of a CV whose readings hardly ever change nothing is a mismatch") {
  Bench bench;
  bench.evidence.p_value = 0.0;
  bench.belief = belief_in(0.74, 0.25);
  CHECK(bench.judge().verdict == Verdict::kMismatch);
  bench.belief = belief_in(0.76, 0.25);
  CHECK(bench.judge().reason == Reason::kCoarse);
}

TEST_CASE("what follows a signal that is no input is no channel's mismatch") {
  Bench bench;
  bench.confounded = true;
  bench.confounder = 2;
  CHECK(bench.judge().verdict == Verdict::kMatch);  // nothing is off in this one
  bench.evidence.p_value = 1e-9;
  CHECK(bench.judge().verdict == Verdict::kUndetermined);
  CHECK(bench.judge().reason == Reason::kConfounded);
  CHECK(bench.judge().confounder == 2);
  bench.confounder = -1;  // one that nobody logs
  CHECK(bench.judge().reason == Reason::kConfounded);
  CHECK(bench.judge().confounder == -1);
}

TEST_CASE("without rows or with bad data there is no verdict") {
  Bench bench;
  bench.bad_data = Reason::kBadData;
  CHECK(bench.judge().reason == Reason::kBadData);
  bench.spoilt = 3;
  CHECK(bench.judge().confounder == 3);
  bench.bad_data = Reason::kNone;
  CHECK(bench.judge().confounder == -1);
  bench.memory.clear();
  CHECK(bench.judge().reason == Reason::kWarmingUp);
  CHECK(bench.judge().p_value == 1.0);
  bench.overdue = true;
  CHECK(bench.judge().reason == Reason::kBadData);
}

TEST_CASE("the mean line takes the place of F where the settings say so") {
  Bench bench;
  bench.settings.threshold = ThresholdKind::kMeanLine;
  bench.peak = {-0.4, 7};
  bench.line = 0.3;
  const ChannelStatus status = bench.judge();
  CHECK(status.verdict == Verdict::kMismatch);
  CHECK(status.statistic == 0.4);
  CHECK(status.threshold == 0.3);
  CHECK(status.lag == 7);
  bench.line = 0.5;
  CHECK(bench.judge().verdict == Verdict::kMatch);
}

}  // namespace
}  // namespace mpm::channel_judge_test
