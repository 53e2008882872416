#include "core/identify/search/trial.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/search/calibration.hpp"
#include "core/identify/search/odds.hpp"
#include "core/identify/search/walk_odds.hpp"

namespace mpm {

void Trials::settle(const Fit* fit) {
  {
    const MutexLock lock(mutex_);
    without_.clear();
  }
  problem_.settle(accepted_, fit);
}

std::size_t Trials::arrange(const std::vector<int>& cvs, std::vector<Effect>& effects) const {
  std::vector<Effect> frozen, free;
  for (const Effect& effect : accepted_) {
    const std::vector<int> own = touched(effect, problem_);
    const bool inside = std::includes(cvs.begin(), cvs.end(), own.begin(), own.end());
    (inside ? free : frozen).push_back(effect);
  }
  const std::size_t first_free = frozen.size();
  effects = std::move(frozen);
  effects.insert(effects.end(), free.begin(), free.end());
  return first_free;
}

const Fit& Trials::without(const std::vector<int>& cvs) {
  {
    const MutexLock lock(mutex_);
    const auto found = without_.find(cvs);
    if (found != without_.end()) return found->second;
  }
  // Two threads may do the same, which gives the same.
  std::vector<Effect> effects;
  const std::size_t first_free = arrange(cvs, effects);
  Fit fit = problem_.fit(std::move(effects), first_free, cvs);
  const MutexLock lock(mutex_);
  return without_.emplace(cvs, std::move(fit)).first->second;
}

Fit Trials::fit_beside(const std::vector<Effect>& candidates, int iterations) {
  tell();
  const std::vector<int> cvs = touched(candidates.front(), problem_);
  std::vector<Effect> effects;
  const std::size_t first_free = arrange(cvs, effects);
  effects.insert(effects.end(), candidates.begin(), candidates.end());
  return problem_.fit(std::move(effects), first_free, cvs, iterations);
}

Trial Trials::attempt(const Effect& candidate, int iterations) {
  tell();  // a round takes seconds
  Trial trial;
  const std::vector<int> cvs = touched(candidate, problem_);
  std::vector<Effect> effects;
  const std::size_t first_free = arrange(cvs, effects);
  effects.push_back(candidate);
  trial.fit = problem_.fit(std::move(effects), first_free, cvs, iterations);
  trial.candidate = trial.fit.effects.back();
  trial.odds = odds_of(trial.fit, trial.fit.effects.size() - 1, without(cvs));
  // What is slow can hide in a noise model that is re-estimated without it: it then takes the noise
  // for a wandering one. So it also counts how the noise model with the cause judges the lack of
  // it.
  if (cause_of(candidate).may_pass_for_noise() && trial.odds > kWanderingNoise &&
      !cuts_a_walk(problem_, trial.fit, trial.fit.effects.size() - 1))
    trial.odds = std::max(trial.odds, settled_odds(trial, cvs) - kSettledNoise);
  if (!material(trial)) trial.odds = std::min(trial.odds, 0.0);
  return trial;
}

// The noise model knows a walk only as far as it remembers, and takes the rest of it for a function
// of time, or for what a channel that changes moves the level by.
double Trials::odds_of(const Fit& with, std::size_t effect, const Fit& without) {
  const Effect& mine = with.effects[effect];
  const double odds = odds_for(mine, with, without);
  const bool changes = mine.onset > 0 && cause_of(mine).acts_through_channels();
  if (!(odds > 0.0) || !(changes || is_of_time(mine))) return odds;
  return std::min(odds, most_odds(problem_, with, effect));
}

std::vector<Trial> Trials::attempt_all(const std::vector<Effect>& candidates, int iterations) {
  std::vector<Trial> trials(candidates.size());
  parallel_.for_each(candidates.size(),
                     [&](std::size_t i) { trials[i] = attempt(candidates[i], iterations); });
  return trials;
}

double Trials::settled_odds(const Trial& trial, const std::vector<int>& cvs) {
  double rows = 0.0;
  for (const int cv : cvs) rows += problem_.data(cv).rows;
  std::vector<Effect> others = trial.fit.effects;
  others.pop_back();
  return problem_.cost_with_noise_of(trial.fit, others) - rows - trial.fit.complexity -
         trial.candidate.search_cost - cause_of(trial.candidate).rarity();
}

/// Whether anyone would care: an error of a channel beyond what a model may be wrong by, and for
/// all others a visible share of what the CV does.
bool Trials::material(const Trial& trial) {
  const std::optional<bool> matters =
      cause_of(trial.candidate).matters(trial.candidate, settings_.materiality);
  if (matters) return *matters;
  std::vector<Effect> without = trial.fit.effects;
  without.pop_back();
  for (const CvFit& state : trial.fit.cvs) {
    const CvData& data = problem_.data(state.cv);
    const Eigen::VectorXd change =
        problem_.simulate(trial.fit.effects, state.cv) - problem_.simulate(without, state.cv);
    const double rows = std::max(1.0, data.known.sum());
    const double mean = data.measured.dot(data.known) / rows;
    const double level = change.mean();
    const double moved = (change.array() - level).square().mean();
    const double all = ((data.measured.array() - mean).square() * data.known.array()).sum() / rows;
    if (moved >= settings_.visible * settings_.visible * all) return true;
  }
  return false;
}

}  // namespace mpm
