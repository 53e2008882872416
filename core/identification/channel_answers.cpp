#include "core/identification/channel_answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/rival_fits.hpp"
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

/// The gain is no better known than all fits say that the data bear: 0 where another input stands
/// in its place. Returns an input that it cannot be told from; -1: none.
int widen_gain(const Material& material, const std::vector<RivalFit>& rivals,
               ChannelAnswer& answer) {
  int input = -1, replaced_by = -1;
  const auto reach = [&](const Interval95& gain) {
    const bool wider = gain.low < answer.gain.low || gain.high > answer.gain.high;
    answer.gain = {std::min(answer.gain.low, gain.low), std::max(answer.gain.high, gain.high)};
    return wider;
  };
  for (const RivalFit& rival : rivals) {
    if (rival.in_place_of == answer.input) {
      reach({0.0, 0.0});
      replaced_by = rival.input;
    }
    for (std::size_t c = 0; c < rival.fit.channels.size(); ++c) {
      const ChannelShape& shape = rival.fit.channels[c];
      if (shape.input != answer.input) continue;
      const double unit = integrates(shape.form) ? 1.0 / material.all.sample_time_s : 1.0;
      const double sd = known_sd(material, answer.cv, rival.fit, c)(0);
      if (reach(around(unit * shape.gain, unit * sd))) input = rival.input;
    }
  }
  return replaced_by >= 0 ? replaced_by : input;
}

/// s.d. of a gain to the gain, of an interval that need not have it in the middle.
double relative_sd(const ChannelAnswer& answer) {
  return 0.5 * (answer.gain.high - answer.gain.low) /
         (kNormalTwoSided95 * std::abs(answer.dynamics->gain));
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

/// Why a channel that was not fitted is not in the model.
LeftOut reason_of_unfitted(const Material& material, const HighOrderModel& model,
                           const ChannelHint& hint, double spread, const ChannelAnswer& answer) {
  const double moves = material.input_spread(answer.input);
  const auto input = static_cast<std::size_t>(answer.input);
  const std::optional<double>& outside = material.outside[input];
  if (moves == 0.0) return LeftOut::kStill;
  if (hint.no_relation) return LeftOut::kGivenNone;
  if (!(spread > 0.0)) return LeftOut::kUnknownCv;
  if (!model.sound) return LeftOut::kTooFewRows;
  if (outside && *outside < kOnlyFeedbackShare && material.feedback_p_value < kFeedback &&
      !material.test_signals[input])
    return LeftOut::kOnlyFeedback;
  return answer.visible_gain * moves > kMatters * spread ? LeftOut::kHidden : LeftOut::kNoRelation;
}

/// Whether a fitted channel is in the model, as far as its own numbers say.
/// `known`: s.d. of the gain to the gain, beside the channels that were chosen.
LeftOut reason_of_fitted(const ChannelAnswer& answer, double known, int sign, bool refused) {
  const double gain = answer.dynamics->gain;
  if (answer.left_out == LeftOut::kOnlyFeedback) return answer.left_out;
  if (gain == 0.0 || gain * sign < 0.0) return LeftOut::kWrongSign;
  if (refused) return LeftOut::kNotConfirmed;
  if (answer.contribution < kLeastContribution) return LeftOut::kTooSmall;
  const bool sign_known = answer.gain.low * answer.gain.high > 0.0;
  return known < kVagueGain && sign_known ? LeftOut::kIdentified : LeftOut::kVague;
}

}  // namespace

std::vector<ChannelAnswer> channel_answers(const Material& material, const HighOrderModel& model,
                                           const std::vector<ChannelHint>& hints, int cv,
                                           const std::optional<PredictionErrorFit>& fit,
                                           const NoiseAssumption& noise, bool refused) {
  std::vector<ChannelAnswer> answers(hints.size());
  const double spread =
      spread_of(as_measured(material, cv, material.all.cvs.col(cv)), material.all.known.col(cv));
  const double typical = model.sound ? typical_time_constant(model, fit) : 1.0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ChannelAnswer& answer = answers[i];
    answer.cv = cv;
    answer.input = static_cast<int>(i);
    answer.visible_gain = model.sound
                              ? kNormalTwoSided95 * 2.0 * gain_sd(model, answer.input, typical)
                              : std::numeric_limits<double>::infinity();
    answer.left_out = reason_of_unfitted(material, model, hints[i], spread, answer);
  }
  if (!fit) return answers;
  std::vector<int> hidden;
  for (const ChannelAnswer& answer : answers)
    if (answer.left_out == LeftOut::kHidden &&
        std::none_of(fit->channels.begin(), fit->channels.end(),
                     [&](const ChannelShape& shape) { return shape.input == answer.input; }))
      hidden.push_back(answer.input);
  const std::vector<double> worth = worth_of_channels(material.all, cv, *fit, noise);
  const std::vector<RivalFit> rivals = rival_fits(material, model, hints, cv, *fit, noise, hidden);
  for (std::size_t c = 0; c < fit->channels.size(); ++c) {
    const ChannelShape& shape = fit->channels[c];
    ChannelAnswer& answer = answers[static_cast<std::size_t>(shape.input)];
    state_numbers(material, *fit, c, answer);
    state_step(*fit, c, material.all.sample_time_s, answer);
    answer.p_value =
        f_upper_tail(worth[c] / kNumbersOfChannel, kNumbersOfChannel, std::max(1.0, fit->rows));
    const double known = relative_sd(answer);
    const int other = widen_gain(material, rivals, answer);
    const double wider = relative_sd(answer);
    if (wider > known)
      for (std::size_t k = 0; k < answer.step.size(); ++k)
        answer.step_sd[k] = std::hypot(answer.step_sd[k],
                                       answer.step[k] * std::sqrt(wider * wider - known * known));
    const VectorXd given = response(shape, material.all.inputs.col(shape.input), material.all.runs);
    answer.contribution = spread_of(given, VectorXd::Ones(given.size())) / spread;
    answer.left_out =
        reason_of_fitted(answer, known, hints[static_cast<std::size_t>(shape.input)].sign, refused);
    if (answer.left_out == LeftOut::kVague)
      answer.entangled_with = other >= 0 ? other : partner(*fit, c);
  }
  return answers;
}

}  // namespace mpm
