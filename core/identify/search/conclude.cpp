#include "core/identify/search/conclude.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/fit/mean_reversion.hpp"
#include "core/identify/search/calibration.hpp"
#include "core/identify/search/odds.hpp"
#include "core/identify/search/trial.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// The effects of a fit, this one last.
std::vector<Effect> with_last(const Fit& fit, std::size_t effect) {
  std::vector<Effect> effects = fit.effects;
  std::rotate(effects.begin() + static_cast<std::ptrdiff_t>(effect),
              effects.begin() + static_cast<std::ptrdiff_t>(effect) + 1, effects.end());
  return effects;
}

/// Cost of the CVs that an effect touches with one of its coordinates held `off` from its value.
double cost_at(Problem& problem, const Fit& fit, std::size_t effect, Index coordinate, double off) {
  std::vector<Effect> effects = with_last(fit, effect);
  Coordinate& held = effects.back().coordinates[static_cast<std::size_t>(coordinate)];
  held.value = std::clamp(held.value + off, held.low, held.high);
  held.prior_mean = held.value;
  held.prior_sd *= 1e-6;
  const std::vector<int> cvs = touched(effects.back(), problem);
  return problem.fit(effects, effects.size() - 1, cvs, 3).cost;
}

/// Inputs that the model left out have operating points that nobody knows: how far apart they took
/// the CV.
double range_of_new_inputs(Problem& problem, const std::vector<Effect>& effects, int cv) {
  std::vector<Effect> others;
  std::copy_if(effects.begin(), effects.end(), std::back_inserter(others),
               [&](const Effect& effect) {
                 return effect.edit != &causes::unmodelled_input() || effect.place.cv != cv;
               });
  if (others.size() == effects.size()) return 0.0;
  const Eigen::VectorXd moved = problem.simulate(effects, cv) - problem.simulate(others, cv);
  return moved.maxCoeff() - moved.minCoeff();
}

/// How far at most the inputs that keep to one side of their operating points take a CV, CV units:
/// a level that a wrong gain of theirs could make as well.
double level_of_inputs(Problem& problem, int cv) {
  const Eigen::VectorXd simulated = problem.simulate({}, cv);
  double level = 0.0;
  for (const ChannelSpec& channel : problem.model().channels) {
    if (channel.cv != cv) continue;
    const Effect twice{&causes::gain(), {cv, channel.input}, {{&kGainRatio, 2.0}}};
    const Eigen::ArrayXd does = problem.simulate({twice}, cv) - simulated;
    const double mean = does.mean();
    if (mean * mean > (does - mean).square().mean()) level += does.abs().maxCoeff();
  }
  return level;
}

/// By how much a CV is off from the first row on, beyond small errors.
struct Level {
  double value = 0.0, sd = 0.0;  ///< CV units
  double noise = 0.0;            ///< s.d.
};

/// Nothing where it is no more than the noise, its own estimate or a new input's operating point
/// may make.
std::optional<Level> level_of(Problem& problem, const CvFit& fit, const SearchResult& result) {
  const CvData& data = problem.data(fit.cv);
  // Runs have levels of their own, which are nobody's fault.
  if (data.runs.size() > 1) return std::nullopt;
  Level level;
  level.value = data.nuisances(0, 0) * fit.beta(0);
  level.noise = std::sqrt(fit.residual.squaredNorm() / std::max(1.0, data.known.sum()));
  const double memory = std::max(kLeastReturn, 1.0 - fit.noise.coefficients.sum());
  const double rows = std::max(1.0, independence({fit}) * data.rows);
  level.sd = std::sqrt(fit.variance / rows) / memory;
  const double size = std::abs(level.value);
  if (!(size > kOffsetInNoise * level.noise && size > kOffsetInSd * level.sd)) return std::nullopt;
  if (size <= range_of_new_inputs(problem, result.fit.effects, fit.cv)) return std::nullopt;
  return level;
}

void name(const Level& level, CvFit& fit, SearchResult& result) {
  Named named;
  named.effect = causes::constant_offset(fit.cv, level.value, level.noise);
  named.evidence = level.value * level.value / (level.sd * level.sd);
  named.confidence = kOffsetConfidence;
  const Index old = result.fit.covariance.rows();
  result.fit.covariance.conservativeResize(old + 1, old + 1);
  result.fit.covariance.col(old).setZero();
  result.fit.covariance.row(old).setZero();
  result.fit.covariance(old, old) = level.sd * level.sd;
  result.fit.effects.push_back(named.effect);
  result.named.push_back(std::move(named));
  fit.beta(0) = 0.0;
}

}  // namespace

void widen_kinked(Problem& problem, SearchResult& result, const std::function<void()>& tell) {
  Index first = 0;
  for (std::size_t e = 0; e < result.fit.effects.size(); ++e) {
    const Effect& effect = result.fit.effects[e];
    const auto count = static_cast<Index>(effect.coordinates.size());
    for (Index i = 0; i < std::min<Index>(cause_of(effect).kinked_numbers(), count); ++i) {
      double& variance = result.fit.covariance(first + i, first + i);
      const double sd = std::max(std::sqrt(variance),
                                 1e-3 * effect.coordinates[static_cast<std::size_t>(i)].prior_sd);
      tell();
      const double least = cost_at(problem, result.fit, e, i, 0.0);
      double reach = 0.0;
      for (const double side : {-1.0, 1.0})
        for (const double steps : kReachesOfRise)
          if (cost_at(problem, result.fit, e, i, side * steps * sd) < least + kRise)
            reach = std::max(reach, steps * sd);
      variance = std::max(variance, reach * reach / kRise);
    }
    first += count;
  }
}

void spread_onsets(Problem& problem, SearchResult& result, const std::function<void()>& tell) {
  Index first = 0;
  for (std::size_t e = 0; e < result.fit.effects.size(); ++e) {
    const Effect& effect = result.fit.effects[e];
    const auto count = static_cast<Index>(effect.coordinates.size());
    if (effect.edit->knows_onset() && !effect.certain && !causes::is_constant_offset(effect)) {
      tell();
      std::vector<Effect> effects = with_last(result.fit, e);
      const std::vector<int> cvs = touched(effect, problem);
      const auto fit_from = [&](Index onset) {
        effects.back() = effect;
        effects.back().onset = onset;
        return problem.fit(effects, effects.size() - 1, cvs, kStepsOfAnOnset);
      };
      const Fit here = fit_from(effect.onset);
      Eigen::VectorXd squares = Eigen::VectorXd::Zero(count);
      auto weights = static_cast<double>(kNearestOnset);
      for (const Index side : {Index{-1}, Index{1}})
        for (Index rows = kNearestOnset;; rows *= 2) {
          const Index onset = effect.onset + side * rows;
          if (onset < 0 || onset + kNearestOnset >= problem.samples()) break;
          const Fit there = fit_from(onset);
          const double worse = there.cost - here.cost;
          if (!(worse < kNoOnset)) break;
          const double weight = static_cast<double>(rows) * std::exp(-0.5 * worse);
          weights += weight;
          for (Index i = 0; i < count; ++i) {
            const auto c = static_cast<std::size_t>(i);
            const double moved =
                there.effects.back().coordinates[c].value - effect.coordinates[c].value;
            squares(i) += weight * moved * moved;
          }
        }
      result.fit.covariance.diagonal().segment(first, count) += squares / weights;
    }
    first += count;
  }
}

void name_levels(Problem& problem, const std::vector<int>& except, const std::vector<int>& doubted,
                 SearchResult& result) {
  const auto is_one_of = [](const std::vector<int>& cvs, int cv) {
    return std::find(cvs.begin(), cvs.end(), cv) != cvs.end();
  };
  for (CvFit& fit : result.fit.cvs) {
    if (is_one_of(except, fit.cv)) continue;
    const std::optional<Level> level = level_of(problem, fit, result);
    // A walk is anywhere, for nobody knows how long it has gone on.
    if (!level || !comes_back_beside_breaks(left_of(problem.data(fit.cv), fit),
                                            causes::breaks_of(result.fit.effects, fit.cv)))
      continue;
    if (is_one_of(doubted, fit.cv) && std::abs(level->value) <= level_of_inputs(problem, fit.cv))
      continue;
    name(*level, fit, result);
  }
}

void name_known_levels(Problem& problem, const std::vector<Effect>& known, SearchResult& result) {
  for (CvFit& fit : result.fit.cvs) {
    const auto is_own = [&fit](const Effect& effect) {
      return causes::is_constant_offset(effect) && effect.place.cv == fit.cv;
    };
    const auto same = std::find_if(known.begin(), known.end(), is_own);
    const std::vector<Effect>& effects = result.fit.effects;
    if (same == known.end() || std::any_of(effects.begin(), effects.end(), is_own)) continue;
    const std::optional<Level> level = level_of(problem, fit, result);
    if (level && std::abs(level->value - same->value(kSize, 0.0)) < kSameLevelSd * level->sd &&
        std::abs(level->value) > level_of_inputs(problem, fit.cv))
      name(*level, fit, result);
  }
}

}  // namespace mpm
