#include "core/identify/search/refine.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/identify/search/calibration.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// The same effect from another moment on, around its own, up to `reach` rows to either side.
std::vector<Effect> other_onsets(const Effect& effect, Index reach, Index samples) {
  constexpr Index kMargin = 5;  // rows at either end
  std::vector<Effect> found;
  for (const double share : {-1.0, -0.5, 0.5, 1.0}) {
    const Index onset =
        effect.onset + static_cast<Index>(std::lround(share * static_cast<double>(reach)));
    if (onset < kMargin || onset + kMargin >= samples || onset == effect.onset) continue;
    found.push_back(effect);
    found.back().onset = onset;
  }
  return found;
}

/// Takes the other trial if it is more probable.
bool improve(Trial& trial, Trial other, double by) {
  if (!(other.odds > trial.odds + by)) return false;
  trial = std::move(other);
  return true;
}

}  // namespace

void place_onset(Trials& trials, Trial& trial) {
  Problem& problem = trials.problem();
  const Index margin = problem.samples() / 50 + 5;
  Index reach = std::max<Index>(2, problem.samples() / kFirstReach);
  while (reach >= 2) {
    bool moved = false;
    const std::vector<Effect> others = other_onsets(trial.candidate, reach, problem.samples());
    for (Trial& other : trials.attempt_all(others, kOnsetSteps))
      moved = improve(trial, std::move(other), kBetterOnset) || moved;
    // The best row near, all else held.
    if (!trial.candidate.edit->knows_onset() && reach > kWidestBlindReach) {
      const Index first = std::max(margin, trial.candidate.onset - reach);
      const Index last = std::min(problem.samples() - margin, trial.candidate.onset + reach);
      Effect other = trial.candidate;
      if (first < last) other.onset = problem.best_onset(trial.fit, first, last);
      if (other.onset != trial.candidate.onset)
        moved = improve(trial, trials.attempt(other, kBestOnsetSteps), kBetterOnset) || moved;
    }
    if (!moved) reach /= 2;
  }
}

void share_onset(Trials& trials, const Trial& best, Trial& trial) {
  if (best.candidate.onset == 0 || trial.candidate.onset == 0 ||
      trial.candidate.onset == best.candidate.onset)
    return;
  Effect other = trial.candidate;
  other.onset = best.candidate.onset;
  improve(trial, trials.attempt(other, kTrialSteps), kBetterOnset);
}

void look_closer(Trials& tries, const Screening& screening, std::vector<Trial>& trials) {
  std::vector<Effect> tried;
  tried.reserve(trials.size());
  for (const Trial& trial : trials) tried.push_back(trial.candidate);
  const std::vector<Effect> near = cause_of(tried[0]).closer_look(tried[0], tried);
  std::vector<std::pair<double, Effect>> scored(near.size());
  tries.parallel().for_each(near.size(), [&](std::size_t i) {
    tries.tell();
    scored[i] = {screening.score(near[i]), near[i]};
  });
  std::sort(scored.begin(), scored.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Effect> likeliest;
  for (std::size_t i = 0; i < std::min(kCloserLooks, scored.size()); ++i)
    likeliest.push_back(std::move(scored[i].second));
  for (Trial& trial : tries.attempt_all(likeliest, kTrialSteps)) trials.push_back(std::move(trial));
}

void step_about(Trials& trials, Trial& trial) {
  const Cause& cause = cause_of(trial.candidate);
  const Stepping stepping = cause.stepping(trial.candidate);
  for (const double reach : stepping.reaches)
    for (bool moved = true; moved;) {
      moved = false;
      for (int i = 0; i < stepping.neighbours; ++i) {
        const Effect other = cause.neighbour(trial.candidate, reach, i, trials.problem());
        if (!improve(trial, trials.attempt(other, kNeighbourSteps), kBetterStep)) continue;
        moved = true;
        if (stepping.from_the_first) break;
      }
    }
}

}  // namespace mpm
