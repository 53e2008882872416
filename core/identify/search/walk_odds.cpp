#include "core/identify/search/walk_odds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/fit/mean_reversion.hpp"
#include "core/identify/fit/walk.hpp"
#include "core/identify/search/calibration.hpp"

namespace mpm {
namespace {

using Eigen::VectorXd;

/// How surely a CV of a fit comes back (`beyond_a_walk`).
double against_a_walk(const Problem& problem, const Fit& fit, const CvFit& state) {
  return beyond_a_walk(left_beside_a_walk(problem.data(state.cv), state),
                       causes::breaks_of(fit.effects, state.cv));
}

}  // namespace

bool is_of_time(const Effect& effect) {
  return causes::is_break(effect) || causes::is_unnamed(cause_of(effect));
}

std::optional<double> evidence_on_walk(Problem& problem, const Fit& fit, std::size_t effect,
                                       const CvFit& state) {
  std::vector<Effect> others = fit.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(effect));
  const CvData& data = problem.data(state.cv);
  const VectorXd own =
      (problem.simulate(fit.effects, state.cv) - problem.simulate(others, state.cv))
          .cwiseProduct(data.known);
  const VectorXd without = state.residual + own;
  const WalkSteps before = walk_steps(data, state, without);
  const VectorXd errors = before.rows_of(without), signature = before.rows_of(own);
  const double information = signature.squaredNorm();
  if (!(information > 0.0)) return std::nullopt;
  const VectorXd with = without - errors.dot(signature) / information * own;
  const double left = walk_steps(data, state, with).rows_of(with).squaredNorm();
  const double evidence = before.rows() * std::log(errors.squaredNorm() / left);
  return std::isnan(evidence) ? 0.0 : std::max(0.0, evidence);
}

double most_odds(Problem& problem, const Fit& fit, std::size_t effect) {
  double evidence = 0.0, against = 0.0;
  bool acts = false;
  for (const CvFit& state : fit.cvs)
    if (const auto of_steps = evidence_on_walk(problem, fit, effect, state)) {
      acts = true;
      evidence += *of_steps;
      against += std::max(0.0, against_a_walk(problem, fit, state));
    }
  if (!acts || std::isinf(evidence)) return std::numeric_limits<double>::infinity();
  const Effect& mine = fit.effects[effect];
  const auto numbers = static_cast<double>(mine.coordinates.size());
  return evidence - numbers * std::log1p(evidence) + kAgainstWalk * against - mine.search_cost -
         cause_of(mine).rarity();
}

bool cuts_a_walk(const Problem& problem, const Fit& fit, std::size_t effect) {
  const Effect& mine = fit.effects[effect];
  if (!is_of_time(mine)) return false;
  return std::any_of(fit.cvs.begin(), fit.cvs.end(), [&](const CvFit& state) {
    return state.cv == mine.place.cv && against_a_walk(problem, fit, state) <= 0.0;
  });
}

}  // namespace mpm
