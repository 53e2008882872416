#include "core/identification/test_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identification/calibration.hpp"

namespace mpm {
namespace {

bool wants_movement(LeftOut left_out) {
  switch (left_out) {
    case LeftOut::kStill:
    case LeftOut::kTooFewRows:
    case LeftOut::kOnlyFeedback:
    case LeftOut::kHidden:
    case LeftOut::kVague:
    case LeftOut::kNotConfirmed:
      return true;
    default:
      return false;
  }
}

/// A move within the MV's limits; nothing where they are not known.
std::optional<double> move_by_limits(const TestLimits& limits, int input) {
  const TestLimits::Range& range = limits.inputs[static_cast<std::size_t>(input)];
  if (!range.low || !range.high) return std::nullopt;
  return 0.5 * kShareOfRange * (*range.high - *range.low);
}

/// Nothing was seen, for the input moved so little beside what its limits allow that a move of a
/// test may yet do what matters.
bool hidden_within_limits(const Identification& identification, const TestLimits& limits,
                          const ChannelAnswer& answer) {
  const std::optional<double> move = move_by_limits(limits, answer.input);
  return answer.left_out == LeftOut::kNoRelation && move &&
         answer.visible_gain * *move >
             kMatters * identification.cvs[static_cast<std::size_t>(answer.cv)].spread;
}

double settling_of(const ChannelAnswer& answer, double sample_time_s) {
  const TransferFunction& tf = *answer.dynamics;
  const double times =
      answer.pair ? answer.pair->time / answer.pair->damping
                  : std::accumulate(tf.time_constants_s.begin(), tf.time_constants_s.end(), 0.0);
  return tf.dead_time_s + kSettlingTimes * std::max(times, sample_time_s);
}

/// Slowest of the channels that are known: of this CV, else of any.
double settling_s(const Identification& identification, int cv) {
  const double sample_time_s = identification.model.sample_time_s;
  double own = 0.0, any = 0.0;
  for (const ChannelAnswer& answer : identification.channels) {
    if (answer.left_out != LeftOut::kIdentified) continue;
    const double settling = settling_of(answer, sample_time_s);
    any = std::max(any, settling);
    if (answer.cv == cv) own = std::max(own, settling);
  }
  if (own > 0.0) return own;
  return any > 0.0 ? any : identification.longest_lag_s;
}

std::optional<double> amplitude_of(const Identification& identification, const TestLimits& limits,
                                   int input) {
  const auto i = static_cast<std::size_t>(input);
  std::optional<double> amplitude = move_by_limits(limits, input);
  if (!amplitude && identification.input_spread[i] > 0.0)
    amplitude = kMoreThanBefore * identification.input_spread[i];
  if (!amplitude) return amplitude;
  for (const ChannelAnswer& answer : identification.channels) {
    if (answer.input != input || !answer.dynamics || answer.dynamics->integrating) continue;
    const TestLimits::Range& range = limits.cvs[static_cast<std::size_t>(answer.cv)];
    const double gain = std::max(std::abs(answer.gain.low), std::abs(answer.gain.high));
    if (range.low && range.high && gain > 0.0)
      amplitude = std::min(*amplitude, kShareOfCvRange * (*range.high - *range.low) / gain);
  }
  return amplitude;
}

}  // namespace

std::vector<PlannedTest> test_plan(const Identification& identification, const TestLimits& limits,
                                   int mv_count) {
  std::vector<PlannedTest> plan;
  const double sample_time_s = identification.model.sample_time_s;
  for (int input = 0; input < mv_count; ++input) {
    PlannedTest test;
    test.input = input;
    double noise_rows = 0.0;  // until an effect that matters is far from what noise makes
    for (const ChannelAnswer& answer : identification.channels) {
      if (answer.input != input || (!wants_movement(answer.left_out) &&
                                    !hidden_within_limits(identification, limits, answer)))
        continue;
      test.cvs.push_back(answer.cv);
      const CvAnswer& cv = identification.cvs[static_cast<std::size_t>(answer.cv)];
      test.settling_s = std::max(test.settling_s, settling_s(identification, answer.cv));
      if (cv.spread > 0.0)
        noise_rows = std::max(noise_rows,
                              std::pow(kWantedSd * cv.long_run_sd / (kMatters * cv.spread), 2.0));
    }
    if (test.cvs.empty()) continue;
    test.amplitude = amplitude_of(identification, limits, input);
    const double wanted_s = noise_rows * sample_time_s;
    if (wanted_s <= kStepSettlings * test.settling_s) {
      test.signal = TestSignal::kSteps;
      test.hold_s = test.settling_s;
      test.duration_s = kStepsOfTest * test.settling_s;
    } else {
      test.signal = TestSignal::kBinary;
      test.hold_s = kSwitchShare * test.settling_s;
      test.duration_s = std::max(wanted_s, kFewestSettlings * test.settling_s);
    }
    plan.push_back(test);
  }
  return plan;
}

}  // namespace mpm
