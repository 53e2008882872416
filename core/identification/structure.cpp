#include "core/identification/structure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/identification/calibration.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// Where the free numbers of channel `which` begin among all.
Index first_number(const PredictionErrorFit& fit, std::size_t which) {
  Index first = 0;
  for (std::size_t c = 0; c < which; ++c)
    first += static_cast<Index>(free_numbers(fit.channels[c]).size());
  return first;
}

double numbers(const PredictionErrorFit& fit) {
  return static_cast<double>(first_number(fit, fit.channels.size()));
}

/// Bayesian information criterion (Schwarz 1978).
double bic(const PredictionErrorFit& fit) {
  return fit.cost + numbers(fit) * std::log(std::max(2.0, fit.rows));
}

/// The next richer forms of a channel, begun where they do the same or nearly so.
std::vector<ChannelShape> richer(const ChannelShape& shape) {
  std::vector<ChannelShape> result;
  const auto add = [&](ChannelForm form, auto change) {
    if (integrates(form) && !shape.may_integrate) return;
    ChannelShape next = shape;
    next.form = form;
    change(next);
    result.push_back(next);
  };
  const auto integrating = [](ChannelShape& next) { next.gain /= next.time_constant; };
  switch (shape.form) {
    case ChannelForm::kFirstOrder:
      add(ChannelForm::kSecondOrder, [](ChannelShape& next) {
        next.second = std::max(kFastest, kSecondShare * next.time_constant);
        const double delay = next.dead_time_known ? 0.0 : std::min(next.dead_time, next.second);
        next.dead_time -= delay;
      });
      add(ChannelForm::kDamped, [](ChannelShape& next) {
        // What a first order takes for dead time is half the slow beginning of a pair.
        const double given = next.dead_time_known ? 0.0 : 0.5 * next.dead_time;
        next.dead_time -= given;
        next.time_constant = std::max(kFastest, kPairTime * (given + next.time_constant));
        next.damping = kDampedStart;
      });
      for (const LeadStart& start : kLeadStarts) {
        if (start.lead < 0.0 && shape.sign != 0) continue;
        add(ChannelForm::kSecondOrderLead, [&](ChannelShape& next) {
          next.second = start.second * next.time_constant;
          next.lead = start.lead * next.time_constant;
          next.time_constant *= start.first;
          next.gain *= start.gain;
        });
      }
      // An inverse response that was taken for dead time (Pade: half the delay as lead and as lag).
      if (shape.dead_time > kLongDeadTime && !shape.dead_time_known && shape.sign == 0)
        add(ChannelForm::kSecondOrderLead, [](ChannelShape& next) {
          next.second = 0.5 * next.dead_time;
          next.lead = -next.second;
          next.dead_time = 0.0;
        });
      add(ChannelForm::kIntegrator, integrating);
      break;
    case ChannelForm::kSecondOrder:
      add(ChannelForm::kDamped, [](ChannelShape& next) {
        const double product = next.time_constant * next.second;
        next.damping =
            std::min(kMostDamping, 0.5 * (next.time_constant + next.second) / std::sqrt(product));
        next.time_constant = std::sqrt(product);
      });
      add(ChannelForm::kSecondOrderLead, [](ChannelShape&) {});
      add(ChannelForm::kIntegratorLag, [&](ChannelShape& next) {
        const auto [fast, slow] = std::minmax(next.time_constant, next.second);
        next.gain /= slow;
        next.time_constant = fast;
      });
      break;
    case ChannelForm::kIntegrator:
      add(ChannelForm::kIntegratorLag, [](ChannelShape& next) { next.time_constant = 1.0; });
      break;
    case ChannelForm::kSecondOrderLead:
      // One lag more: beside the quicker one, and in place of dead time that it looked like.
      for (const double share : kThirdShares)
        add(ChannelForm::kThirdOrderLead, [&](ChannelShape& next) {
          next.third = std::max(kFastest, share * std::min(next.time_constant, next.second));
          const double delay = next.dead_time_known ? 0.0 : std::min(next.dead_time, next.third);
          next.dead_time -= delay;
        });
      break;
    case ChannelForm::kDamped:
    case ChannelForm::kThirdOrderLead:
    case ChannelForm::kIntegratorLag:
      break;
  }
  return result;
}

double longest_run(const IdentificationData& data) {
  Index longest = 0;
  for (const Run& run : data.runs) longest = std::max(longest, run.count);
  return static_cast<double>(longest);
}

/// A level is moved by all its flows: one that integrates beside others that are only very slow is
/// no better than very slow itself. All of these as integrators, where there are several; else
/// nothing.
std::vector<ChannelShape> slow_ones_integrating(const std::vector<ChannelShape>& channels,
                                                double run) {
  std::vector<ChannelShape> changed = channels;
  int count = 0;
  for (ChannelShape& shape : changed) {
    const bool one_lag = shape.form == ChannelForm::kFirstOrder;
    const bool two_lags =
        shape.form == ChannelForm::kSecondOrder || shape.form == ChannelForm::kSecondOrderLead;
    if ((!one_lag && !two_lags) || !shape.may_integrate ||
        slowest_time(shape) < kMayIntegrateShare * run)
      continue;
    const auto [fast, slow] = std::minmax({shape.time_constant, one_lag ? 0.0 : shape.second});
    shape.gain /= slow;
    shape.time_constant = fast;
    shape.lead = 0.0;
    shape.form = one_lag ? ChannelForm::kIntegrator : ChannelForm::kIntegratorLag;
    ++count;
  }
  if (count < 2) changed.clear();
  return changed;
}

bool too_slow(const PredictionErrorFit& fit, const IdentificationData& data) {
  return std::any_of(fit.channels.begin(), fit.channels.end(), [&](const ChannelShape& shape) {
    return slowest_time(shape) > kSlowestShare * longest_run(data);
  });
}

/// The next simpler forms of one with a lead.
std::vector<ChannelShape> simpler(const ChannelShape& shape) {
  std::vector<ChannelShape> result;
  if (shape.form == ChannelForm::kSecondOrderLead) {
    result.push_back(shape);
    result.back().form = ChannelForm::kSecondOrder;
    result.back().lead = 0.0;
  }
  if (shape.form == ChannelForm::kSecondOrderLead || shape.form == ChannelForm::kSecondOrder)
    for (const double time_constant : {shape.time_constant, shape.second}) {
      result.push_back(shape);
      result.back().form = ChannelForm::kFirstOrder;
      result.back().time_constant = time_constant;
    }
  return result;
}

/// Tried: channel `which` in another form.
PredictionErrorFit with_form(const IdentificationData& data, int cv, const PredictionErrorFit& fit,
                             std::size_t which, const ChannelShape& form,
                             const NoiseAssumption& noise) {
  std::vector<ChannelShape> changed = fit.channels;
  changed[which] = form;
  return fit_prediction_error(data, cv, std::move(changed), noise, kTrialSteps);
}

/// With simpler forms, one at a time, as long as that pays (BIC).
PredictionErrorFit simplified(const IdentificationData& data, int cv, PredictionErrorFit fit,
                              const NoiseAssumption& noise) {
  for (;;) {
    std::optional<PredictionErrorFit> best;
    for (std::size_t c = 0; c < fit.channels.size(); ++c)
      for (const ChannelShape& shape : simpler(fit.channels[c])) {
        PredictionErrorFit other = with_form(data, cv, fit, c, shape, noise);
        if (bic(other) < bic(fit) && (!best || bic(other) < bic(*best))) best = std::move(other);
      }
    if (!best) return fit;
    fit = fit_prediction_error(data, cv, std::move(best->channels), noise, kMostSteps);
  }
}

PredictionErrorFit without(const IdentificationData& data, int cv, const PredictionErrorFit& fit,
                           std::size_t which, const NoiseAssumption& noise) {
  std::vector<ChannelShape> rest = fit.channels;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(which));
  return fit_prediction_error(data, cv, std::move(rest), noise, kMostSteps);
}

double squared_z(const PredictionErrorFit& fit, std::size_t which) {
  const double ratio = fit.channels[which].gain / sd_of(fit, which)(0);
  return ratio * ratio;
}

}  // namespace

Eigen::VectorXd sd_of(const PredictionErrorFit& fit, std::size_t which) {
  const auto count = static_cast<Index>(free_numbers(fit.channels[which]).size());
  return fit.covariance.diagonal().segment(first_number(fit, which), count).cwiseSqrt();
}

PredictionErrorFit pruned(const IdentificationData& data, int cv, PredictionErrorFit fit,
                          const NoiseAssumption& noise) {
  for (;;) {
    // Of inputs that move alike, the one whose gain looks least sure need not be the one too many.
    std::optional<PredictionErrorFit> best;
    for (std::size_t c = 0; c < fit.channels.size(); ++c) {
      if (squared_z(fit, c) > kSureRatioSquare) continue;
      PredictionErrorFit rest = without(data, cv, fit, c, noise);
      if (!best || rest.cost < best->cost) best = std::move(rest);
    }
    if (!best || best->cost - fit.cost > needed_of_channel(fit.rows)) return fit;
    fit = std::move(*best);
  }
}

std::vector<double> worth_of_channels(const IdentificationData& data, int cv,
                                      const PredictionErrorFit& fit, const NoiseAssumption& noise) {
  std::vector<double> worth;
  for (std::size_t c = 0; c < fit.channels.size(); ++c) {
    const double z2 = squared_z(fit, c);
    worth.push_back(z2 > kSureRatioSquare ? z2 : without(data, cv, fit, c, noise).cost - fit.cost);
  }
  return worth;
}

PredictionErrorFit simplest_structure(const IdentificationData& data, int cv,
                                      const StartSearch& search,
                                      std::vector<std::vector<ChannelShape>> starts,
                                      const NoiseAssumption& noise) {
  std::optional<PredictionErrorFit> best;
  for (std::vector<ChannelShape>& start : starts) {
    PredictionErrorFit fit = pruned(
        data, cv, fit_prediction_error(data, cv, std::move(start), noise, kMostSteps), noise);
    while (std::optional<std::vector<ChannelShape>> more = search.enlarged(fit.channels)) {
      PredictionErrorFit fuller = pruned(
          data, cv, fit_prediction_error(data, cv, std::move(*more), noise, kMostSteps), noise);
      if (bic(fuller) + kWorthRicher > bic(fit)) break;
      fit = std::move(fuller);
    }
    if (!best || bic(fit) < bic(*best)) best = std::move(fit);
  }
  return std::move(*best);
}

std::vector<PredictionErrorFit> grown_structures(const IdentificationData& data, int cv,
                                                 const StartSearch& search,
                                                 PredictionErrorFit simplest,
                                                 const NoiseAssumption& noise) {
  std::vector<PredictionErrorFit> grown = {std::move(simplest)};
  for (;;) {
    const PredictionErrorFit& now = grown.back();
    std::optional<PredictionErrorFit> best;
    for (std::size_t c = 0; c < now.channels.size(); ++c)
      for (const ChannelShape& shape : richer(now.channels[c])) {
        PredictionErrorFit fit = with_form(data, cv, now, c, shape, noise);
        if (bic(fit) + kWorthRicher > bic(now) ||
            slowest_time(fit.channels[c]) > kSlowestShare * longest_run(data))
          continue;
        if (!best || bic(fit) < bic(*best)) best = std::move(fit);
      }
    std::vector<ChannelShape> levels = slow_ones_integrating(now.channels, longest_run(data));
    if (!levels.empty()) {
      PredictionErrorFit fit =
          fit_prediction_error(data, cv, std::move(levels), noise, kTrialSteps);
      // It has no more numbers than now: nothing richer that has to be worth it.
      if (bic(fit) < bic(best ? *best : now)) best = std::move(fit);
    }
    if (!best) break;
    // What was wrong there hid what is wrong elsewhere: next, every form is tried again.
    grown.push_back(fit_prediction_error(data, cv, std::move(best->channels), noise, kMostSteps));
  }
  std::optional<std::vector<ChannelShape>> shared = search.with_shared_lags(grown.front().channels);
  if (shared && shared->size() > 1) {
    PredictionErrorFit fit = simplified(
        data, cv, fit_prediction_error(data, cv, std::move(*shared), noise, kMostSteps), noise);
    if (!too_slow(fit, data) && bic(fit) + kWorthRicher <= bic(grown.back()))
      grown.push_back(std::move(fit));
  }
  return grown;
}

}  // namespace mpm
