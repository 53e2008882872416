#include "core/identification/form_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/feedback_test.hpp"
#include "core/identification/start_values.hpp"
#include "core/identification/structure.hpp"
#include "core/identify/evidence/outside_movement.hpp"
#include "core/identify/fit/split.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

Material material(const Recording& recording, bool open_loop) {
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
    result.input_spread(i) = spread > kStillShare * std::abs(all.input_mean(i)) ? spread : 0.0;
  }
  result.outside = outside_shares(recording, recording.cvs);
  result.test_signals = test_signals(all);
  result.feedback_p_value = open_loop ? 1.0 : feedback_p_value(all, 0);
  result.open_loop = open_loop || feedback_p_value(all, 1) > kFeedback;
  return result;
}

VectorXd as_measured(const Material& material, int cv, const Eigen::Ref<const VectorXd>& values) {
  if (material.cross.brought.size() == 0) return values;
  return values + material.cross.brought.col(cv);
}

NoiseAssumption noise_model(const IdentificationData& data, int cv) {
  const double rows = data.known.col(cv).sum() / static_cast<double>(data.runs.size());
  return {{std::clamp(static_cast<int>(rows / kRowsPerNoiseLag), 1, kNoiseOrder), 0.0}, 1.0};
}

namespace {

/// Mean square of the free run on the unseen rows, with the level of the first ones. Inputs are
/// about their mean, at which a CV that integrates and stays where it is stands still.
double carried_square(const Material& material, int cv, const std::vector<ChannelShape>& channels) {
  const IdentificationData& data = material.all;
  const Index first = material.first.samples(), rest = data.samples() - first;
  const VectorXd known = data.known.col(cv);
  VectorXd left = data.cvs.col(cv);
  for (const ChannelShape& shape : channels)
    left -= response(shape, data.inputs.col(shape.input), data.runs);
  left = left.cwiseProduct(known);
  const double level = left.head(first).sum() / std::max(1.0, known.head(first).sum());
  left = (left.array() - level) * known.array();
  return left.tail(rest).squaredNorm() / std::max(1.0, known.tail(rest).sum());
}

/// The simplest of some structures that does best on rows that none was fitted to.
Choice best_unseen(const Material& material, int cv, const std::vector<PredictionErrorFit>& grown,
                   const NoiseAssumption& noise) {
  Choice choice;
  choice.noise = noise;
  double least = std::numeric_limits<double>::infinity();
  const double most = material.open_loop ? kMostWorse * kMostWorse *
                                               carried_square(material, cv, grown.front().channels)
                                         : std::numeric_limits<double>::infinity();
  for (const PredictionErrorFit& fit : grown) {
    if (&fit != &grown.front() && carried_square(material, cv, fit.channels) > most) continue;
    const double now = fit_prediction_error(material.unseen, cv, fit.channels, noise, 0).cost;
    if (now < least) least = now, choice.channels = fit.channels;
  }
  const PredictionErrorFit nothing = fit_prediction_error(material.unseen, cv, {}, noise, 0);
  choice.confirmed = least < nothing.cost - kLeastGainOfPrediction * nothing.rows;
  choice.unseen_square =
      fit_prediction_error(material.unseen, cv, choice.channels, output_error(), 0).variance;
  if (material.open_loop) {
    const double spread = fit_prediction_error(material.unseen, cv, {}, output_error(), 0).variance;
    choice.confirmed = choice.confirmed && choice.unseen_square < spread;
  }
  return choice;
}

/// Without a noise model: from a regression without the CV's own past, or from the channels that
/// were found with a noise model, which sees slower ones than that regression has lags.
std::optional<Choice> by_output_error(const Material& material,
                                      const std::vector<ChannelHint>& hints,
                                      const std::vector<ChannelShape>& found, int cv) {
  const HighOrderModel model = high_order_model(material.first, cv, 0);
  if (!model.sound) return std::nullopt;
  const StartSearch search(model, hints, material.all.sample_time_s);
  std::vector<std::vector<ChannelShape>> starts = search.best_sets();
  starts.push_back(found);
  std::optional<PredictionErrorFit> best;  // of them: what it leaves says how much is known
  for (const std::vector<ChannelShape>& start : starts) {
    PredictionErrorFit fit =
        fit_prediction_error(material.first, cv, start, output_error(), kMostSteps);
    if (!best || fit.variance < best->variance) best = std::move(fit);
  }
  const NoiseAssumption noise = output_error(*best);
  const std::vector<PredictionErrorFit> grown = grown_structures(
      material.first, cv, search,
      simplest_structure(material.first, cv, search, std::move(starts), noise), noise);
  Choice choice = best_unseen(material, cv, grown, noise);
  choice.output_error = true;
  return choice;
}

/// Whether a choice's free run of the unseen rows is clearly better than another's: carried on from
/// the rows before, for a stretch in which little moves fits any model at a level of its own; but
/// at that where the unseen rows are another run, or something integrates.
bool clearly_better(const Material& material, int cv, const Choice& choice, const Choice& other) {
  const std::vector<Border>& borders = material.all.borders;
  const Index first = material.first.samples();
  bool carried = std::none_of(borders.begin(), borders.end(),
                              [&](const Border& border) { return border.row == first; });
  for (const Choice* each : {&choice, &other})
    for (const ChannelShape& shape : each->channels) carried = carried && !integrates(shape.form);
  if (!carried) return choice.unseen_square < kClearlyBetter * other.unseen_square;
  return carried_square(material, cv, choice.channels) <
         kClearlyBetter * carried_square(material, cv, other.channels);
}

/// The inputs that act are picked on all rows; their forms are to carry over from the first rows to
/// the unseen.
Choice choose(const Material& material, const std::vector<ChannelHint>& hints,
              const HighOrderModel& all, int cv) {
  const StartSearch search(all, hints, material.all.sample_time_s);
  const NoiseAssumption usual = noise_model(material.all, cv),
                        noise = noise_model(material.first, cv);
  PredictionErrorFit simplest =
      simplest_structure(material.all, cv, search, search.best_sets(), usual);
  const std::vector<PredictionErrorFit> grown = grown_structures(
      material.first, cv, search,
      fit_prediction_error(material.first, cv, std::move(simplest.channels), noise, kMostSteps),
      noise);
  Choice choice = best_unseen(material, cv, grown, noise);
  if (!material.open_loop) return choice;
  // What the noise model takes for noise may be what a poor form leaves.
  std::optional<Choice> other = by_output_error(material, hints, grown.front().channels, cv);
  if (other && other->confirmed &&
      (!choice.confirmed || clearly_better(material, cv, *other, choice)))
    return std::move(*other);
  return choice;
}

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

}  // namespace

Chosen choose_form(const Material& material, const std::vector<ChannelHint>& hints,
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
  return cost(other) + kSureRatioSquare < cost(given) ? std::move(other) : std::move(given);
}

}  // namespace mpm
