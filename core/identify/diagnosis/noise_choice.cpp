#include "core/identify/diagnosis/noise_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/channel_estimates.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/validation.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/free_run.hpp"
#include "core/identify/fit/mean_reversion.hpp"
#include "core/identify/search/walk_odds.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Free runs of such a CV go where its load does, and its noise is smooth by itself.
bool integrates(const ModelSpec& model, int cv) {
  return LinearModel(model).integrating().row(cv).any();
}

Explained explain_with(const NoiseModel& noise, const ModelSpec& model, int model_inputs,
                       const Recording& recording, const SearchSettings& settings) {
  Explained explained;
  explained.problem =
      std::make_unique<Problem>(model, model_inputs, recording, Tolerances{}, noise);
  explained.found = search(*explained.problem, settings);
  return explained;
}

/// Sum over the CVs of the log of the free run's error on the rows from `first` on.
double log_error(const Explained& explained, const Recording& recording, Index first) {
  const std::vector<bool> all(explained.found.named.size(), true);
  const std::vector<bool> keep(static_cast<std::size_t>(recording.cvs.cols()), true);
  const ModelSpec model = extend(*explained.problem, explained.found, all, keep);
  Simulator simulator(recording);
  double sum = 0.0;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    if (integrates(model, cv)) continue;
    const VectorXd errors =
        (recording.cvs.col(cv) - free_run(simulator, model, cv)).tail(recording.samples() - first);
    const double error = mean_of_finite(errors.cwiseAbs2());
    sum += std::isfinite(error) ? std::log(error) : 1e6;
  }
  return sum;
}

bool is_too_smooth(const Explained& explained) {
  return std::any_of(
      explained.found.fit.cvs.begin(), explained.found.fit.cvs.end(), [&](const CvFit& fit) {
        if (integrates(explained.problem->model(), fit.cv)) return false;
        const CvData& data = explained.problem->data(fit.cv);
        const double all = fit.residual.squaredNorm() / std::max(1.0, data.known.sum());
        return fit.variance < kTooSmooth * all;
      });
}

/// Whether a channel is named of a CV that wanders: there smoothness is no sign of structure, and
/// drifts and steps that follow the CV would hide the channel.
bool names_channels_of_wandering(const Explained& explained) {
  const SearchResult& found = explained.found;
  const ModelSpec& model = explained.problem->model();
  const auto wandering = [&](const CvFit& fit) {
    return wanders(fit.residual, slowest_of_cv_s(model, fit.cv, 1.0) / model.sample_time_s);
  };
  return std::any_of(found.named.begin(), found.named.end(), [&](const Named& named) {
    const Cause& cause = cause_of(named.effect);
    if (named.effect.certain || !cause.acts_through_channels() || causes::is_unnamed(cause))
      return false;
    return std::any_of(found.fit.cvs.begin(), found.fit.cvs.end(), [&](const CvFit& fit) {
      return touches(named.effect, model, fit.cv) && wandering(fit);
    });
  });
}

/// Whether a break is named of a CV that wanders beside it all the same. A bounded noise
/// takes each piece of a walk for a drift or a shift, and its last level explains what comes next.
bool names_pieces_of_a_walk(const Explained& explained) {
  const Fit& fit = explained.found.fit;
  for (std::size_t i = 0; i < fit.effects.size(); ++i)
    if (causes::is_break(fit.effects[i]) &&
        !integrates(explained.problem->model(), fit.effects[i].place.cv) &&
        cuts_a_walk(*explained.problem, fit, i))
      return true;
  return false;
}

/// Coefficients, up to `most`, of which Akaike's criterion is least.
int order_of(const CvFit& fit, const CvData& data, int most) {
  int best = kLeastOrder;
  double least = std::numeric_limits<double>::infinity();
  for (int order = kLeastOrder; order <= most; order += kOrderStep) {
    Whitening noise = fit_whitening(fit.residual, data.weights, {.order = order, .bound = 0.0});
    noise.borders = fit.noise.borders;
    const double misfit = noise.apply(fit.residual).cwiseAbs2().dot(data.weights);
    const double cost = data.rows * std::log(misfit) + 2.0 * order;
    if (!(cost < least)) continue;
    least = cost;
    best = order;
  }
  return best;
}

}  // namespace

NoiseModel free_noise(const ModelSpec& model, int model_inputs, const Recording& recording) {
  const auto most = static_cast<int>(
      std::clamp<Index>(recording.samples() / kRowsPerCoefficient, kLeastOrder, kMostOrder));
  NoiseModel chosen{.order = kLeastOrder, .bound = 0.0};
  Problem problem(model, model_inputs, recording, Tolerances{}, {.order = most, .bound = 0.0});
  std::vector<int> cvs(static_cast<std::size_t>(model.cv_count));
  std::iota(cvs.begin(), cvs.end(), 0);
  for (const CvFit& fit : problem.fit({}, 0, cvs).cvs)
    if (integrates(model, fit.cv) ||
        wanders(fit.residual, slowest_of_cv_s(model, fit.cv, 1.0) / model.sample_time_s))
      chosen.order = std::max(chosen.order, order_of(fit, problem.data(fit.cv), most));
  return chosen;
}

Explained explain(const ModelSpec& model, int model_inputs, const Recording& recording,
                  const SearchSettings& settings) {
  const auto explain_on = [&](const NoiseModel& noise, const Recording& on) {
    return explain_with(noise, model, model_inputs, on, settings);
  };
  const NoiseModel free = free_noise(model, model_inputs, recording);
  Explained explained = explain_on(free, recording);
  const bool blind =
      explained.found.named.empty() &&
      unknown_gains(estimate_channels(*explained.problem, explained.found, settings)) > 0;
  if (!blind && (!is_too_smooth(explained) || names_channels_of_wandering(explained)))
    return explained;
  const Index first = (kComparedQuarter - 1) * recording.samples() / kComparedQuarter;
  const Recording train = part(recording, 0, first);
  const double with_free = log_error(explain_on(free, train), recording, first);
  const double with_bounded = log_error(explain_on(kBoundedNoise, train), recording, first);
  if (!(with_bounded < with_free - (blind ? kSomewhatLess : kClearlyLess))) return explained;
  Explained bounded = explain_on(kBoundedNoise, recording);
  return names_pieces_of_a_walk(bounded) ? std::move(explained) : std::move(bounded);
}

}  // namespace mpm
