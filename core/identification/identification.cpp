#include "core/identification/identification.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/channel_answers.hpp"
#include "core/identification/cross_noise.hpp"
#include "core/identification/dead_time_reach.hpp"
#include "core/identification/feedback_test.hpp"
#include "core/identification/form_choice.hpp"
#include "core/identification/residual_tests.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/simulator.hpp"
#include "core/identify/fit/split.hpp"
#include "core/model/linear_model.hpp"
#include "core/parallel/parallel.hpp"
#include "core/statistics/historian.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

CvOutcome identify_cv(const Material& material, const IdentificationSettings& settings, int cv) {
  CvOutcome outcome;
  CvAnswer& answer = outcome.answer;
  answer.cv = cv;
  answer.spread =
      spread_of(as_measured(material, cv, material.all.cvs.col(cv)), material.all.known.col(cv));
  const std::vector<ChannelHint> hints = hints_of(settings, cv, material.input_spread);
  const HighOrderModel model = high_order_model(material.all, cv, kPastLags);
  Choice choice;
  if (model.sound) {
    outcome.longest_lag = model.blocks.back().last;
    Chosen chosen = choose_form(material, hints, model, cv);
    choice = std::move(chosen.choice);
    outcome.fit = std::move(chosen.fit);
    answer.output_error = choice.output_error;
    widen_dead_times(material.all, cv, choice.noise, *outcome.fit);
    const PredictionErrorFit whitened =
        choice.output_error ? fit_prediction_error(material.all, cv, outcome.fit->channels,
                                                   noise_model(material.all, cv), 0)
                            : *outcome.fit;
    answer.rows = whitened.rows;
    answer.innovation_sd = std::sqrt(whitened.variance);
    answer.noise_sd =
        spread_of(as_measured(material, cv, whitened.residual), material.all.known.col(cv));
    answer.long_run_sd =
        answer.innovation_sd / std::max(kLeastReturn, 1.0 - whitened.noise.coefficients.sum());
    answer.whiteness_p_value = whiteness_p_value(whitened);
    for (std::size_t i = 0; i < hints.size(); ++i)
      answer.input_p_values.push_back(
          material.input_spread(static_cast<Index>(i)) > 0.0
              ? past_input_p_value(material.all, whitened, static_cast<int>(i))
              : 1.0);
  }
  outcome.channels =
      channel_answers(material, model, hints, cv, outcome.fit, choice.noise, !choice.confirmed);
  return outcome;
}

/// Holm (1979): which p-values are below what a family error allows, and each by itself below what
/// makes sure. One that BIC asks for and that is not sure stays in the fit, for the others' sake.
void correct_for_many(std::vector<ChannelAnswer>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return channels[a].p_value < channels[b].p_value;
  });
  bool rejected = true;
  for (std::size_t n = 0; n < order.size(); ++n) {
    ChannelAnswer& answer = channels[order[n]];
    rejected = rejected && answer.p_value < kSure &&
               answer.p_value * static_cast<double>(order.size() - n) < kFamilyError;
    if (!rejected &&
        (answer.left_out == LeftOut::kIdentified || answer.left_out == LeftOut::kVague))
      answer.left_out = LeftOut::kHidden;
  }
}

/// The inputs at which the integrating CVs stand still, nearest to the mean in s.d. of each: what a
/// CV drifts by beside its inputs is then no drift.
VectorXd balanced_inputs(const Material& material, const std::vector<CvOutcome>& outcomes,
                         const std::vector<ChannelAnswer>& channels) {
  const IdentificationData& data = material.all;
  MatrixXd slopes = MatrixXd::Zero(data.cvs.cols(), data.inputs.cols());
  VectorXd drift = VectorXd::Zero(data.cvs.cols());
  for (const ChannelAnswer& answer : channels) {
    if (answer.left_out != LeftOut::kIdentified || !answer.dynamics->integrating) continue;
    slopes(answer.cv, answer.input) =
        answer.dynamics->gain * data.sample_time_s * material.input_spread(answer.input);
    drift(answer.cv) = outcomes[static_cast<std::size_t>(answer.cv)].fit->drift;
  }
  if (slopes.isZero()) return data.input_mean;
  const VectorXd moves = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(slopes).solve(-drift);
  return data.input_mean + moves.cwiseProduct(material.input_spread);
}

ChannelSpec channel_of(const ChannelAnswer& answer, double sample_time_s) {
  const TransferFunction& tf = *answer.dynamics;
  if (!answer.pair) return {answer.cv, answer.input, tf, {}};
  return {
      answer.cv, answer.input, sampled(*answer.pair, tf.gain, tf.dead_time_s, sample_time_s), {}};
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
      model.channels.push_back(channel_of(answer, data.sample_time_s));
  model.input_origin = balanced_inputs(material, outcomes, channels);
  for (const CvOutcome& outcome : outcomes) {
    if (!outcome.fit) continue;
    for (std::size_t r = 0; r < data.runs.size(); ++r)
      model.output_origin(outcome.answer.cv) += outcome.fit->level(static_cast<Index>(r)) *
                                                static_cast<double>(data.runs[r].count) /
                                                static_cast<double>(data.samples());
  }
  for (const ChannelAnswer& answer : channels)
    if (answer.left_out == LeftOut::kIdentified && !answer.dynamics->integrating)
      model.output_origin(answer.cv) += answer.dynamics->gain * (model.input_origin(answer.input) -
                                                                 data.input_mean(answer.input));
  return model;
}

/// The level of a CV some of whose fitted channels the model leaves out: what the rest misses on
/// average. A CV that integrates has none.
void level_what_is_left(const Material& material, const CvOutcome& outcome, ModelSpec& model) {
  const int cv = outcome.answer.cv;
  std::size_t kept = 0;
  for (const ChannelSpec& channel : model.channels) kept += channel.cv == cv ? 1 : 0;
  if (!outcome.fit || kept == outcome.fit->channels.size() ||
      LinearModel(model).integrating().row(cv).any())
    return;
  Simulator simulator(material.recording);
  const VectorXd missed = material.recording.cvs.col(cv) - free_run(simulator, model, cv);
  double sum = 0.0, count = 0.0;
  for (const double each : missed)
    if (std::isfinite(each)) sum += each, count += 1.0;
  if (count > 0.0) model.output_origin(cv) += sum / count;
}

/// How far the free run of the whole recording is off on its last quarter.
double unseen_rmse(const Material& material, const ModelSpec& model, int cv) {
  Simulator simulator(material.recording);
  const VectorXd simulated = free_run(simulator, model, cv);
  double sum = 0.0, count = 0.0;
  for (Index k = material.first.samples(); k < simulated.size(); ++k) {
    const double error = material.recording.cvs(k, cv) - simulated(k);
    if (std::isfinite(error)) sum += error * error, count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

ModelSpec levelled_model(const Material& material, const std::vector<CvOutcome>& outcomes,
                         const std::vector<ChannelAnswer>& channels) {
  ModelSpec model = model_of_answers(material, outcomes, channels);
  for (const CvOutcome& outcome : outcomes) level_what_is_left(material, outcome, model);
  return model;
}

/// Channels of a vague gain (slow ones, of which little more than the slope is seen, and those that
/// mostly go back) stay where the free run of unseen rows is clearly worse without them, unless not
/// even the sign is known. Where feedback moves the inputs, a free run does not tell.
void keep_vague_that_matter(const Material& material, const std::vector<CvOutcome>& outcomes,
                            std::vector<ChannelAnswer>& channels) {
  if (!material.open_loop) return;
  for (const CvOutcome& outcome : outcomes) {
    const int cv = outcome.answer.cv;
    std::vector<ChannelAnswer> kept = channels;
    bool any = false;
    for (ChannelAnswer& answer : kept)
      if (answer.cv == cv && answer.left_out == LeftOut::kVague &&
          answer.gain.low * answer.gain.high > 0.0) {
        answer.left_out = LeftOut::kIdentified;
        any = true;
      }
    if (!any) continue;
    const double without = unseen_rmse(material, levelled_model(material, outcomes, channels), cv);
    if (unseen_rmse(material, levelled_model(material, outcomes, kept), cv) <
        std::sqrt(kClearlyBetter) * without)
      channels = std::move(kept);
  }
}

/// Whether a controller may move some input.
bool controlled(const Material& material) {
  if (material.open_loop) return false;
  for (std::size_t i = 0; i < material.test_signals.size(); ++i)
    if (!material.test_signals[i] && material.input_spread(static_cast<Index>(i)) > 0.0)
      return true;
  return false;
}

/// Each CV without what disturbs the others: where no feedback moves the inputs, it does no harm.
Material by_itself(const Material& material) {
  Material result = material;
  if (!controlled(material)) return result;
  CrossNoise cross = cross_noise(material.all);
  result.all.cvs -= cross.brought;
  result.first.cvs -= cross.brought.topRows(material.first.samples());
  result.unseen.cvs -= cross.brought.bottomRows(material.unseen.samples());
  result.cross = std::move(cross);
  return result;
}

/// Whether a CV goes with a test signal of its own row.
bool answers_within_row(const Material& material) {
  const std::vector<double> p_values = feedback_p_values(material.all, 0);
  bool within = false;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    within = within || (material.test_signals[i] &&
                        p_values[i] * static_cast<double>(p_values.size()) < kFeedback);
  return within;
}

/// With the CVs that are read only now and then as if unknown: what stands between two readings
/// would pass for dead time. `read_every`: samples, of each CV; 0 = every one.
Recording without_seldom_read(Recording recording, std::vector<Index>& read_every) {
  for (Index cv = 0; cv < recording.cvs.cols(); ++cv) {
    read_every.push_back(reading_interval(recording.cvs.col(cv)));
    if (read_every.back() > 0)
      recording.cvs.col(cv).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return recording;
}

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

/// All of identify() but for what no CV answers. `read_every` as of without_seldom_read().
Identification identify_measured(const Recording& measured, const std::vector<Index>& read_every,
                                 const IdentificationSettings& settings) {
  const Material given = material(measured, settings.open_loop);
  std::vector<CvOutcome> outcomes(static_cast<std::size_t>(measured.cvs.cols()));
  const Parallel parallel(settings.threads);
  const Material fitted = by_itself(given);
  parallel.for_each(outcomes.size(), [&](std::size_t cv) {
    outcomes[cv] = identify_cv(fitted, settings, static_cast<int>(cv));
  });
  Identification result;
  result.outside_shares = given.outside;
  result.feedback_p_value = given.feedback_p_value;
  result.within_row = answers_within_row(given);
  result.input_spread.assign(given.input_spread.begin(), given.input_spread.end());
  for (const CvOutcome& outcome : outcomes)
    result.longest_lag_s =
        std::max(result.longest_lag_s, outcome.longest_lag * measured.sample_time_s);
  for (const CvOutcome& outcome : outcomes)
    result.channels.insert(result.channels.end(), outcome.channels.begin(), outcome.channels.end());
  for (ChannelAnswer& channel : result.channels)
    if (channel.left_out == LeftOut::kUnknownCv &&
        read_every[static_cast<std::size_t>(channel.cv)] > 0)
      channel.left_out = LeftOut::kReadSeldom;
  correct_for_many(result.channels);
  keep_vague_that_matter(given, outcomes, result.channels);
  result.model = levelled_model(given, outcomes, result.channels);
  for (CvOutcome& outcome : outcomes) {
    CvAnswer& answer = outcome.answer;
    answer.unseen_rmse = unseen_rmse(given, result.model, answer.cv);
    answer.unseen_spread =
        spread_of(given.unseen.cvs.col(answer.cv), given.unseen.known.col(answer.cv));
    answer.read_every = read_every[static_cast<std::size_t>(answer.cv)];
    result.cvs.push_back(answer);
  }
  return result;
}

}  // namespace

Index needed_rows(Index inputs) {
  return 4 * kRowsPerUnknown * (kUnknownsPerInput * inputs + kOtherUnknowns) / 3;
}

Identification identify(const Recording& recording, const IdentificationSettings& settings) {
  if (recording.samples() < needed_rows(recording.inputs.cols())) return nothing_of(recording);
  std::vector<Index> read_every;
  const Recording measured = without_seldom_read(recording, read_every);
  const std::vector<Pulse> pulses = short_pulses(measured);
  const Recording calm = without(measured, pulses);
  Identification result = identify_measured(calm, read_every, settings);
  const std::vector<Pulse> none = unanswered(result.model, calm, pulses);
  if (none != pulses) result = identify_measured(without(measured, none), read_every, settings);
  result.unanswered = none;
  return result;
}

}  // namespace mpm
