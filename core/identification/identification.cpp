#include "core/identification/identification.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/identification/calibration.hpp"
#include "core/identification/feedback_test.hpp"
#include "core/identification/high_order.hpp"
#include "core/identification/identification_data.hpp"
#include "core/identification/residual_tests.hpp"
#include "core/identification/start_values.hpp"
#include "core/identification/structure.hpp"
#include "core/identify/evidence/outside_movement.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/simulator.hpp"
#include "core/identify/fit/split.hpp"
#include "core/parallel/parallel.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kStill = 1e-9;  ///< of its level: rounding, not movement

/// What all CVs are fitted on.
struct Material {
  const Recording& recording;
  IdentificationData all, first, unseen;  ///< first: what forms are chosen on
  VectorXd input_spread;
  std::vector<std::optional<double>> outside;
  double feedback_p_value = 1.0;
  bool open_loop = false;  ///< as far as anything shows
};

Material material(const Recording& recording) {
  const Index rows = fitted_rows(recording, 1.0 - kValidationShare);
  Material result{recording,
                  identification_data(recording),
                  identification_data(part(recording, 0, rows)),
                  identification_data(part(recording, rows, recording.samples() - rows)),
                  {},
                  {},
                  {}};
  const IdentificationData& all = result.all;
  const VectorXd everywhere = VectorXd::Ones(all.samples());
  result.input_spread.resize(all.inputs.cols());
  for (Index i = 0; i < all.inputs.cols(); ++i) {
    const double spread = spread_of(all.inputs.col(i), everywhere);
    result.input_spread(i) = spread > kStill * std::abs(all.input_mean(i)) ? spread : 0.0;
  }
  result.outside = outside_shares(recording, recording.cvs);
  result.feedback_p_value = feedback_p_value(all, 0);
  result.open_loop = feedback_p_value(all, 1) > kFeedback;
  return result;
}

/// One CV's part of the outcome.
struct CvOutcome {
  std::optional<PredictionErrorFit> fit;
  std::vector<ChannelAnswer> channels;
  CvAnswer answer;
  double longest_lag = 0.0;  ///< samples
};

std::vector<ChannelHint> hints_of(const IdentificationSettings& settings, int cv,
                                  const VectorXd& input_spread) {
  std::vector<ChannelHint> hints(static_cast<std::size_t>(input_spread.size()));
  for (std::size_t i = 0; i < hints.size(); ++i) {
    hints[i].cv = cv;
    hints[i].input = static_cast<int>(i);
  }
  for (const ChannelHint& hint : settings.hints)
    if (hint.cv == cv) hints[static_cast<std::size_t>(hint.input)] = hint;
  for (std::size_t i = 0; i < hints.size(); ++i)
    if (input_spread(static_cast<Index>(i)) == 0.0) hints[i].no_relation = true;
  return hints;
}

NoiseAssumption noise_model(const IdentificationData& data, int cv) {
  const double rows = data.known.col(cv).sum() / static_cast<double>(data.runs.size());
  return {{std::clamp(static_cast<int>(rows / kRowsPerNoiseLag), 1, kNoiseOrder), 0.0}, 1.0};
}

/// Channels of a CV, how its noise is taken, and what the samples say that were left out.
struct Choice {
  std::vector<ChannelShape> channels;
  NoiseAssumption noise;
  bool output_error = false;
  bool confirmed = false;      ///< predictions are better with the channels
  double unseen_square = 0.0;  ///< mean, of the free run
};

/// The simplest of some structures that does best on rows that none was fitted to.
Choice best_unseen(const Material& material, int cv, const std::vector<PredictionErrorFit>& grown,
                   const NoiseAssumption& noise) {
  Choice choice;
  choice.noise = noise;
  double least = std::numeric_limits<double>::infinity();
  for (const PredictionErrorFit& fit : grown) {
    const double now = fit_prediction_error(material.unseen, cv, fit.channels, noise, 0).cost;
    if (now < least) least = now, choice.channels = fit.channels;
  }
  const PredictionErrorFit nothing = fit_prediction_error(material.unseen, cv, {}, noise, 0);
  choice.confirmed = least < nothing.cost - kLeastGainOfPrediction * nothing.rows;
  choice.unseen_square =
      fit_prediction_error(material.unseen, cv, choice.channels, output_error(), 0).variance;
  return choice;
}

/// Without a noise model, from a regression without the CV's own past.
std::optional<Choice> by_output_error(const Material& material,
                                      const std::vector<ChannelHint>& hints, int cv) {
  const HighOrderModel model = high_order_model(material.first, cv, 0);
  if (!model.sound) return std::nullopt;
  const StartSearch search(model, hints, material.all.sample_time_s);
  const NoiseAssumption noise = output_error(fit_prediction_error(
      material.first, cv, search.best_sets().front(), output_error(), kMostSteps));
  const std::vector<PredictionErrorFit> grown = grown_structures(
      material.first, cv, simplest_structure(material.first, cv, search, noise), noise);
  Choice choice = best_unseen(material, cv, grown, noise);
  choice.output_error = true;
  return choice;
}

/// The inputs that act are picked on all rows; their forms are to carry over from the first rows to
/// the unseen.
Choice choose(const Material& material, const std::vector<ChannelHint>& hints,
              const HighOrderModel& all, int cv) {
  const StartSearch search(all, hints, material.all.sample_time_s);
  const NoiseAssumption usual = noise_model(material.all, cv),
                        noise = noise_model(material.first, cv);
  PredictionErrorFit simplest = simplest_structure(material.all, cv, search, usual);
  const std::vector<PredictionErrorFit> grown = grown_structures(
      material.first, cv,
      fit_prediction_error(material.first, cv, std::move(simplest.channels), noise, kMostSteps),
      noise);
  Choice choice = best_unseen(material, cv, grown, noise);
  if (!material.open_loop) return choice;
  // What the noise model takes for noise may be what a poor form leaves.
  std::optional<Choice> other = by_output_error(material, hints, cv);
  if (other && other->confirmed &&
      (!choice.confirmed || other->unseen_square < kClearlyBetter * choice.unseen_square))
    return std::move(*other);
  return choice;
}

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

void state_numbers(const Material& material, const PredictionErrorFit& fit, std::size_t which,
                   ChannelAnswer& answer) {
  const ChannelShape& shape = fit.channels[which];
  const double dt = material.all.sample_time_s;
  const std::vector<ShapeNumber> numbers = free_numbers(shape);
  const VectorXd sd = sd_of(fit, which);
  answer.form = shape.form;
  answer.dynamics = transfer_function(shape, dt);
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
        answer.time_constants.push_back(
            {std::exp(interval.low) * dt, std::exp(interval.high) * dt});
        break;
      case ShapeNumber::kLead:
        answer.lead_s = {interval.low * dt, interval.high * dt};
        break;
    }
  }
}

void state_step(const PredictionErrorFit& fit, std::size_t which, double sample_time_s,
                ChannelAnswer& answer) {
  const ChannelShape& shape = fit.channels[which];
  const double times =
      shape.time_constant + (shape.form == ChannelForm::kFirstOrder ? 0.0 : shape.second);
  const auto stride =
      static_cast<Index>(std::ceil((shape.dead_time + kStepTimes * times) / kStepPoints + 1e-9));
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
                          ? kLogStep * std::max(1e-12, std::abs(value))
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

void state_channels(const Material& material, const HighOrderModel& model,
                    const std::vector<ChannelHint>& hints, const NoiseAssumption& noise,
                    bool refused, CvOutcome& outcome) {
  const int cv = outcome.answer.cv;
  const double spread = spread_of(material.all.cvs.col(cv), material.all.known.col(cv));
  const double typical = model.sound ? typical_time_constant(model, outcome.fit) : 1.0;
  std::vector<double> worth;
  if (outcome.fit) worth = worth_of_channels(material.all, cv, *outcome.fit, noise);
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
    else if (outside && *outside < kOnlyFeedback && material.feedback_p_value < kFeedback)
      answer.left_out = LeftOut::kOnlyFeedback;
    else if (answer.visible_gain * material.input_spread(input) > kMatters * spread)
      answer.left_out = LeftOut::kHidden;
    if (outcome.fit)
      for (std::size_t c = 0; c < outcome.fit->channels.size(); ++c) {
        const ChannelShape& shape = outcome.fit->channels[c];
        if (shape.input != answer.input) continue;
        state_numbers(material, *outcome.fit, c, answer);
        state_step(*outcome.fit, c, material.all.sample_time_s, answer);
        answer.p_value = f_upper_tail(worth[c] / 3.0, 3.0, std::max(1.0, outcome.fit->rows));
        const VectorXd given = response(shape, material.all.inputs.col(input), material.all.runs);
        answer.contribution = spread_of(given, VectorXd::Ones(given.size())) / spread;
        if (answer.left_out == LeftOut::kOnlyFeedback) continue;
        const double relative = std::abs(sd_of(*outcome.fit, c)(0) / shape.gain);
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
        if (answer.left_out == LeftOut::kVague) answer.entangled_with = partner(*outcome.fit, c);
      }
    outcome.channels.push_back(answer);
  }
}

/// A choice, and its channels fitted to all rows.
struct Chosen {
  Choice choice;
  PredictionErrorFit fit;
};

Chosen choose_and_fit(const Material& material, const std::vector<ChannelHint>& hints,
                      const HighOrderModel& model, int cv) {
  Choice choice = choose(material, hints, model, cv);
  if (!choice.output_error) choice.noise = noise_model(material.all, cv);
  PredictionErrorFit fit =
      pruned(material.all, cv,
             fit_prediction_error(material.all, cv, choice.channels, choice.noise, kMostSteps),
             choice.noise);
  return {std::move(choice), std::move(fit)};
}

/// With the signs that the user gives, unless the data are far better without: then they contradict
/// them.
Chosen with_signs(const Material& material, const std::vector<ChannelHint>& hints,
                  const HighOrderModel& model, int cv) {
  Chosen given = choose_and_fit(material, hints, model, cv);
  std::vector<ChannelHint> free = hints;
  for (ChannelHint& hint : free) hint.sign = 0;
  if (free == hints) return given;
  Chosen other = choose_and_fit(material, free, model, cv);
  const NoiseAssumption noise = noise_model(material.all, cv);
  const auto cost = [&](const Chosen& chosen) {
    return fit_prediction_error(material.all, cv, chosen.fit.channels, noise, 0).cost;
  };
  return cost(other) + kBeyondDoubt < cost(given) ? std::move(other) : std::move(given);
}

CvOutcome identify_cv(const Material& material, const IdentificationSettings& settings, int cv) {
  CvOutcome outcome;
  CvAnswer& answer = outcome.answer;
  answer.cv = cv;
  answer.spread = spread_of(material.all.cvs.col(cv), material.all.known.col(cv));
  const std::vector<ChannelHint> hints = hints_of(settings, cv, material.input_spread);
  const HighOrderModel model = high_order_model(material.all, cv, kPastLags);
  Choice choice;
  if (model.sound) {
    outcome.longest_lag = model.blocks.back().last;
    Chosen chosen = with_signs(material, hints, model, cv);
    choice = std::move(chosen.choice);
    outcome.fit = std::move(chosen.fit);
    answer.output_error = choice.output_error;
    const PredictionErrorFit whitened =
        choice.output_error ? fit_prediction_error(material.all, cv, outcome.fit->channels,
                                                   noise_model(material.all, cv), 0)
                            : *outcome.fit;
    answer.rows = whitened.rows;
    answer.innovation_sd = std::sqrt(whitened.variance);
    answer.noise_sd = spread_of(whitened.residual, material.all.known.col(cv));
    answer.long_run_sd =
        answer.innovation_sd / std::max(kLeastReturn, 1.0 - whitened.noise.coefficients.sum());
    answer.whiteness_p_value = whiteness_p_value(whitened);
    for (std::size_t i = 0; i < hints.size(); ++i)
      answer.input_p_values.push_back(
          material.input_spread(static_cast<Index>(i)) > 0.0
              ? past_input_p_value(material.all, whitened, static_cast<int>(i))
              : 1.0);
  }
  state_channels(material, model, hints, choice.noise, !choice.confirmed, outcome);
  return outcome;
}

/// Holm (1979): which p-values are below what a family error allows.
void correct_for_many(std::vector<ChannelAnswer>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return channels[a].p_value < channels[b].p_value;
  });
  bool rejected = true;
  for (std::size_t n = 0; n < order.size(); ++n) {
    ChannelAnswer& answer = channels[order[n]];
    rejected = rejected && answer.p_value * static_cast<double>(order.size() - n) < kFamilyError;
    if (!rejected && answer.left_out == LeftOut::kIdentified)
      answer.left_out = LeftOut::kNoRelation;
  }
}

/// The inputs at which the integrating CVs stand still, nearest to the mean in s.d. of each: what a
/// CV drifts by beside its inputs is then no drift.
VectorXd balanced_inputs(const Material& material, const std::vector<CvOutcome>& outcomes,
                         const ModelSpec& model) {
  const IdentificationData& data = material.all;
  MatrixXd slopes = MatrixXd::Zero(model.cv_count, model.input_count);
  VectorXd drift = VectorXd::Zero(model.cv_count);
  for (const ChannelSpec& channel : model.channels) {
    const auto& tf = std::get<TransferFunction>(channel.dynamics);
    if (!tf.integrating) continue;
    slopes(channel.cv, channel.input) =
        tf.gain * data.sample_time_s * material.input_spread(channel.input);
    drift(channel.cv) = outcomes[static_cast<std::size_t>(channel.cv)].fit->drift;
  }
  if (slopes.isZero()) return data.input_mean;
  const VectorXd moves = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(slopes).solve(-drift);
  return data.input_mean + moves.cwiseProduct(material.input_spread);
}

ModelSpec model_of_answers(const Material& material, const std::vector<CvOutcome>& outcomes,
                           const std::vector<ChannelAnswer>& channels) {
  const IdentificationData& data = material.all;
  ModelSpec model;
  model.sample_time_s = data.sample_time_s;
  model.input_count = static_cast<int>(data.inputs.cols());
  model.cv_count = static_cast<int>(data.cvs.cols());
  model.input_blocks.resize(static_cast<std::size_t>(model.input_count));
  model.output_blocks.resize(static_cast<std::size_t>(model.cv_count));
  model.output_origin = data.cv_mean;
  for (const ChannelAnswer& answer : channels)
    if (answer.left_out == LeftOut::kIdentified)
      model.channels.push_back({answer.cv, answer.input, *answer.dynamics, {}});
  model.input_origin = balanced_inputs(material, outcomes, model);
  for (const CvOutcome& outcome : outcomes) {
    if (!outcome.fit) continue;
    for (std::size_t r = 0; r < data.runs.size(); ++r)
      model.output_origin(outcome.answer.cv) += outcome.fit->level(static_cast<Index>(r)) *
                                                static_cast<double>(data.runs[r].count) /
                                                static_cast<double>(data.samples());
  }
  for (const ChannelSpec& channel : model.channels) {
    const auto& tf = std::get<TransferFunction>(channel.dynamics);
    if (!tf.integrating)
      model.output_origin(channel.cv) +=
          tf.gain * (model.input_origin(channel.input) - data.input_mean(channel.input));
  }
  return model;
}

/// How far the free run is off on rows that the choice of forms did not see.
void measure_unseen(const Material& material, const ModelSpec& model, CvAnswer& answer) {
  const Index rows = material.first.samples();
  const Recording unseen = part(material.recording, rows, material.recording.samples() - rows);
  Simulator simulator(unseen);
  const VectorXd simulated = free_run(simulator, model, answer.cv);
  double sum = 0.0, count = 0.0;
  for (Index k = 0; k < simulated.size(); ++k) {
    const double error = unseen.cvs(k, answer.cv) - simulated(k);
    if (std::isfinite(error)) sum += error * error, count += 1.0;
  }
  answer.unseen_rmse = count > 0.0 ? std::sqrt(sum / count) : 0.0;
  answer.unseen_spread =
      spread_of(material.unseen.cvs.col(answer.cv), material.unseen.known.col(answer.cv));
}

}  // namespace

namespace {

/// What too few rows say.
Identification nothing_of(const Recording& recording) {
  Identification result;
  const auto inputs = static_cast<int>(recording.inputs.cols());
  const auto cvs = static_cast<int>(recording.cvs.cols());
  result.model.sample_time_s = recording.sample_time_s;
  result.model.input_count = inputs;
  result.model.cv_count = cvs;
  result.model.input_origin.setZero(inputs);
  result.model.output_origin.setZero(cvs);
  result.model.input_blocks.resize(static_cast<std::size_t>(inputs));
  result.model.output_blocks.resize(static_cast<std::size_t>(cvs));
  result.outside_shares.resize(static_cast<std::size_t>(inputs));
  result.input_spread.resize(static_cast<std::size_t>(inputs), 0.0);
  for (int cv = 0; cv < cvs; ++cv) {
    CvAnswer answer;
    answer.cv = cv;
    result.cvs.push_back(answer);
    for (int input = 0; input < inputs; ++input) {
      ChannelAnswer channel;
      channel.cv = cv;
      channel.input = input;
      channel.left_out = LeftOut::kTooFewRows;
      channel.visible_gain = std::numeric_limits<double>::infinity();
      result.channels.push_back(channel);
    }
  }
  return result;
}

}  // namespace

Identification identify(const Recording& recording, const IdentificationSettings& settings) {
  if (recording.samples() < kFewestRows) return nothing_of(recording);
  const Material given = material(recording);
  std::vector<CvOutcome> outcomes(static_cast<std::size_t>(recording.cvs.cols()));
  const Parallel parallel(settings.threads);
  parallel.for_each(outcomes.size(), [&](std::size_t cv) {
    outcomes[cv] = identify_cv(given, settings, static_cast<int>(cv));
  });
  Identification result;
  result.outside_shares = given.outside;
  result.feedback_p_value = given.feedback_p_value;
  result.input_spread.assign(given.input_spread.begin(), given.input_spread.end());
  for (const CvOutcome& outcome : outcomes)
    result.longest_lag_s =
        std::max(result.longest_lag_s, outcome.longest_lag * recording.sample_time_s);
  for (const CvOutcome& outcome : outcomes)
    result.channels.insert(result.channels.end(), outcome.channels.begin(), outcome.channels.end());
  correct_for_many(result.channels);
  result.model = model_of_answers(given, outcomes, result.channels);
  for (CvOutcome& outcome : outcomes) {
    measure_unseen(given, result.model, outcome.answer);
    result.cvs.push_back(outcome.answer);
  }
  return result;
}

}  // namespace mpm
