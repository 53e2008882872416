#include "core/identify/search/jumps_together.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/identify/causes/cause.hpp"
#include "core/identify/causes/step_moments.hpp"
#include "core/identify/fit/calibration.hpp"
#include "core/identify/search/calibration.hpp"
#include "core/identify/search/odds.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// The largest innovation of a jump's first rows.
double shock_at(const Eigen::VectorXd& innovations, Index onset) {
  const Index rows = std::min(kShockRows, innovations.size() - onset);
  return innovations.segment(onset, rows).lpNorm<Eigen::Infinity>();
}

/// 2 ln of the ways to pick so many moments from all rows with a shock as large as the smallest.
double cost_of_moments(const Eigen::VectorXd& innovations, const std::vector<Effect>& jumps) {
  double smallest = shock_at(innovations, jumps.front().onset);
  for (const Effect& jump : jumps) smallest = std::min(smallest, shock_at(innovations, jump.onset));
  auto picked = static_cast<double>(jumps.size());
  double shocks = picked;
  for (Index k = 0; k < innovations.size(); ++k) {
    const bool own = std::any_of(jumps.begin(), jumps.end(), [k](const Effect& jump) {
      return k >= jump.onset && k < jump.onset + kShockRows;
    });
    if (!own && std::abs(innovations(k)) >= smallest) ++shocks;
  }
  return 2.0 * (std::lgamma(shocks + 1.0) - std::lgamma(picked + 1.0) -
                std::lgamma(shocks - picked + 1.0));
}

/// Of some jumps together, against none of them.
struct Together {
  Fit fit;               ///< the jumps last
  double odds = -1e300;  ///< 2 ln
};

Together fit_together(Trials& trials, const Eigen::VectorXd& innovations,
                      std::vector<Effect>& jumps) {
  Problem& problem = trials.problem();
  const double each = cost_of_moments(innovations, jumps) / static_cast<double>(jumps.size()) +
                      cost_of(static_cast<std::size_t>(problem.model().cv_count));
  Together together;
  for (Effect& jump : jumps) jump.search_cost = each;
  together.fit = trials.fit_beside(jumps, kSecondTrialSteps);
  const Fit& none = trials.without({jumps.front().place.cv});
  if (!std::isfinite(together.fit.cost)) return together;
  double cost = 0.0;
  for (const Effect& jump : jumps) cost += jump.search_cost + cause_of(jump).rarity();
  together.odds = independence(together.fit.cvs) * (none.misfit - together.fit.misfit) +
                  none.complexity - together.fit.complexity - cost;
  return together;
}

}  // namespace

std::vector<Trial> jumps_together(Trials& trials, const Effect& jump, double decisive) {
  const int cv = jump.place.cv;
  const CvData& data = trials.problem().data(cv);
  std::vector<Effect> best_jumps;
  Together best;
  std::optional<Fit> weighing;
  for (std::vector<Effect> before; before.size() < kMostJumps;) {
    trials.settle(nullptr);  // beside rows that all weigh alike a shock is worth what it is
    const Fit so_far =
        before.empty() ? trials.without({cv}) : trials.fit_beside(before, kSecondTrialSteps);
    if (!weighing) weighing = so_far;
    const std::vector<Index> moments = step_moments(data, so_far.cvs.front(), {}, kJumpMoments);
    trials.settle(&*weighing);
    std::vector<Effect> next;
    Together of_next;
    for (const Index moment : moments) {
      std::vector<Effect> tried = before;
      tried.push_back(jump);
      tried.back().onset = moment;
      Together together = fit_together(trials, weighing->cvs.front().innovations, tried);
      if (together.odds <= of_next.odds) continue;
      of_next = std::move(together);
      next = std::move(tried);
    }
    if (next.empty() || (next.size() > 1 && of_next.odds <= 0.0)) break;
    before = next;
    if (of_next.odds <= best.odds) continue;
    best = std::move(of_next);
    best_jumps = std::move(next);
  }
  if (best_jumps.size() < 2 || best.odds < kJumpsTogether) return {};
  const std::size_t first = best.fit.effects.size() - best_jumps.size();
  std::vector<Trial> result;
  for (std::size_t i = 0; i < best_jumps.size(); ++i) {
    std::vector<Effect> others = best_jumps;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Trial trial;
    trial.fit = best.fit;
    trial.candidate = best.fit.effects[first + i];
    trial.odds = odds_for(trial.candidate, best.fit, trials.fit_beside(others, kSecondTrialSteps));
    if (trial.odds < decisive) return {};
    result.push_back(std::move(trial));
  }
  return result;
}

}  // namespace mpm
