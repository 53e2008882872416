#include "core/identification/channel_answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/structure.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Interval95 around(double value, double sd) {
  return {value - kNormalTwoSided95 * sd, value + kNormalTwoSided95 * sd};
}

/// The input whose gain a vague one is traded against.
int partner(const PredictionErrorFit& fit, std::size_t which) {
  Index own = 0, at = 0;
  std::vector<Index> gains;
  for (std::size_t c = 0; c < fit.channels.size(); ++c) {
    gains.push_back(at);
    if (c == which) own = at;
    at += static_cast<Index>(free_numbers(fit.channels[c]).size());
  }
  double largest = kEntangled;
  int input = -1;
  for (std::size_t c = 0; c < fit.channels.size(); ++c) {
    if (c == which) continue;
    const double correlation =
        std::abs(fit.covariance(own, gains[c])) /
        std::sqrt(fit.covariance(own, own) * fit.covariance(gains[c], gains[c]));
    if (correlation > largest) largest = correlation, input = fit.channels[c].input;
  }
  return input;
}

/// s.d. of the free numbers of channel `which`; the gain's is no less than what is known of it.
VectorXd known_sd(const Material& material, int cv, const PredictionErrorFit& fit,
                  std::size_t which) {
  VectorXd sd = sd_of(fit, which);
  const ChannelShape& shape = fit.channels[which];
  if (material.cross.gain_sd.size() > 0 && !integrates(shape.form))
    sd(0) = std::max(sd(0), material.cross.gain_sd(cv, shape.input));
  return sd;
}

void state_numbers(const Material& material, const PredictionErrorFit& fit, std::size_t which,
                   ChannelAnswer& answer) {
  const ChannelShape& shape = fit.channels[which];
  const double dt = material.all.sample_time_s;
  const std::vector<ShapeNumber> numbers = free_numbers(shape);
  const VectorXd sd = known_sd(material, answer.cv, fit, which);
  answer.form = shape.form;
  answer.dynamics = transfer_function(shape, dt);
  if (shape.form == ChannelForm::kDamped)
    answer.pair = DampedPair{shape.time_constant * dt, shape.damping};
  answer.dead_time_s = {shape.dead_time * dt, shape.dead_time * dt};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const double value = number_of(shape, numbers[n]);
    const Interval95 interval = around(value, sd(static_cast<Index>(n)));
    switch (numbers[n]) {
      case ShapeNumber::kGain: {
        const double unit = integrates(shape.form) ? 1.0 / dt : 1.0;
        answer.gain = {interval.low * unit, interval.high * unit};
        break;
      }
      case ShapeNumber::kDeadTime:
        answer.dead_time_s = {std::max(0.0, interval.low * dt), interval.high * dt};
        break;
      case ShapeNumber::kLogTime:
      case ShapeNumber::kLogSecond:
      case ShapeNumber::kLogThird:
        answer.time_constants.push_back(
            {std::exp(interval.low) * dt, std::exp(interval.high) * dt});
        break;
      case ShapeNumber::kLead:
        answer.lead_s = {interval.low * dt, interval.high * dt};
        break;
      case ShapeNumber::kDamping:
        answer.damping = {std::max(0.0, interval.low), interval.high};
        break;
    }
  }
}

void state_step(const PredictionErrorFit& fit, std::size_t which, double sample_time_s,
                ChannelAnswer& answer) {
  const ChannelShape& shape = fit.channels[which];
  const std::vector<double> own = lags(shape);
  const double times = own.size() > 1 ? std::accumulate(own.begin(), own.end(), 0.0)
                                      : std::max(1.0, slowest_time(shape));
  const auto stride = static_cast<Index>(
      std::max(1.0, std::ceil((shape.dead_time + kStepTimes * times) / kStepPoints)));
  VectorXd input = VectorXd::Ones(stride * kStepPoints + 2);
  input(0) = 0.0;  // then y(k) is the answer k - 1 samples after the step
  const std::vector<Run> all = {{0, input.size()}};
  const VectorXd step = response(shape, input, all);
  const std::vector<ShapeNumber> numbers = free_numbers(shape);
  MatrixXd slopes(input.size(), static_cast<Index>(numbers.size()));
  Index first = 0;
  for (std::size_t c = 0; c < which; ++c)
    first += static_cast<Index>(free_numbers(fit.channels[c]).size());
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    ChannelShape other = shape;
    const double value = number_of(shape, numbers[n]);
    const double by = numbers[n] == ShapeNumber::kGain || numbers[n] == ShapeNumber::kLead
                          ? kLogStep * std::max(kLeastValue, std::abs(value))
                          : kLogStep;
    set_number(other, numbers[n], value + by, std::numeric_limits<double>::max());
    slopes.col(static_cast<Index>(n)) = (response(other, input, all) - step) / by;
  }
  const MatrixXd covariance = fit.covariance.block(first, first, slopes.cols(), slopes.cols());
  for (Index k = 1; k < input.size(); k += stride) {
    answer.step_times_s.push_back(static_cast<double>(k - 1) * sample_time_s);
    answer.step.push_back(step(k));
    answer.step_sd.push_back(
        std::sqrt(std::max(0.0, (slopes.row(k) * covariance * slopes.row(k).transpose())(0))));
  }
}

double typical_time_constant(const HighOrderModel& model,
                             const std::optional<PredictionErrorFit>& fit) {
  std::vector<double> times;
  if (fit)
    for (const ChannelShape& shape : fit->channels) times.push_back(shape.time_constant);
  if (times.empty()) return kUsualTimeShare * model.blocks.back().last;
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace

std::vector<ChannelAnswer> channel_answers(const Material& material, const HighOrderModel& model,
                                           const std::vector<ChannelHint>& hints, int cv,
                                           const std::optional<PredictionErrorFit>& fit,
                                           const NoiseAssumption& noise, bool refused) {
  std::vector<ChannelAnswer> answers;
  const double spread =
      spread_of(as_measured(material, cv, material.all.cvs.col(cv)), material.all.known.col(cv));
  const double typical = model.sound ? typical_time_constant(model, fit) : 1.0;
  std::vector<double> worth;
  if (fit) worth = worth_of_channels(material.all, cv, *fit, noise);
  for (std::size_t i = 0; i < hints.size(); ++i) {
    ChannelAnswer answer;
    answer.cv = cv;
    answer.input = static_cast<int>(i);
    const auto input = static_cast<Index>(i);
    answer.visible_gain = model.sound
                              ? kNormalTwoSided95 * 2.0 * gain_sd(model, answer.input, typical)
                              : std::numeric_limits<double>::infinity();
    const std::optional<double>& outside = material.outside[i];
    if (material.input_spread(input) == 0.0)
      answer.left_out = LeftOut::kStill;
    else if (hints[i].no_relation)
      answer.left_out = LeftOut::kGivenNone;
    else if (!(spread > 0.0))
      answer.left_out = LeftOut::kUnknownCv;
    else if (!model.sound)
      answer.left_out = LeftOut::kTooFewRows;
    else if (outside && *outside < kOnlyFeedback && material.feedback_p_value < kFeedback &&
             !material.test_signals[i])
      answer.left_out = LeftOut::kOnlyFeedback;
    else if (answer.visible_gain * material.input_spread(input) > kMatters * spread)
      answer.left_out = LeftOut::kHidden;
    if (fit)
      for (std::size_t c = 0; c < fit->channels.size(); ++c) {
        const ChannelShape& shape = fit->channels[c];
        if (shape.input != answer.input) continue;
        state_numbers(material, *fit, c, answer);
        state_step(*fit, c, material.all.sample_time_s, answer);
        answer.p_value =
            f_upper_tail(worth[c] / kNumbersOfChannel, kNumbersOfChannel, std::max(1.0, fit->rows));
        const VectorXd given = response(shape, material.all.inputs.col(input), material.all.runs);
        answer.contribution = spread_of(given, VectorXd::Ones(given.size())) / spread;
        if (answer.left_out == LeftOut::kOnlyFeedback) continue;
        const double relative = std::abs(known_sd(material, cv, *fit, c)(0) / shape.gain);
        if (shape.gain == 0.0 || shape.gain * hints[i].sign < 0.0)
          answer.left_out = LeftOut::kWrongSign;
        else if (refused)
          answer.left_out = LeftOut::kNotConfirmed;
        else if (answer.contribution < kLeastContribution)
          answer.left_out = LeftOut::kTooSmall;
        else if (!(relative < kVagueGain))
          answer.left_out = LeftOut::kVague;
        else
          answer.left_out = LeftOut::kIdentified;
        if (answer.left_out == LeftOut::kVague) answer.entangled_with = partner(*fit, c);
      }
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace mpm
