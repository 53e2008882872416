#include "core/identify/search/walk_odds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/fit/mean_reversion.hpp"
#include "core/identify/fit/walk.hpp"
#include "core/identify/search/calibration.hpp"

namespace mpm {
namespace {

using Eigen::VectorXd;

const CvFit* fit_of(const Fit& fit, int cv) {
  for (const CvFit& state : fit.cvs)
    if (state.cv == cv) return &state;
  return nullptr;
}

/// How surely the effect's CV comes back (`beyond_a_walk`); infinite where no walk could be taken
/// for the effect.
double against_a_walk(const Problem& problem, const Fit& fit, std::size_t effect) {
  const Effect& mine = fit.effects[effect];
  const CvFit* const state = fit_of(fit, mine.place.cv);
  if (state == nullptr || !(causes::is_break(mine) || causes::is_unnamed(cause_of(mine))))
    return std::numeric_limits<double>::infinity();
  return beyond_a_walk(left_beside_a_walk(problem.data(state->cv), *state),
                       causes::breaks_of(fit.effects, mine.place.cv));
}

}  // namespace

double evidence_on_walk(Problem& problem, const Fit& fit, std::size_t effect) {
  const int cv = fit.effects[effect].place.cv;
  const CvFit* const state = fit_of(fit, cv);
  if (state == nullptr || state->residual.size() < 2) return 0.0;
  std::vector<Effect> others = fit.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(effect));
  const CvData& data = problem.data(cv);
  const VectorXd own =
      (problem.simulate(fit.effects, cv) - problem.simulate(others, cv)).cwiseProduct(data.known);
  const VectorXd without = state->residual + own;
  const WalkSteps before = walk_steps(data, *state, without);
  const VectorXd errors = before.rows_of(without), signature = before.rows_of(own);
  const double information = signature.squaredNorm();
  if (!(information > 0.0)) return 0.0;
  const VectorXd with = without - errors.dot(signature) / information * own;
  const double left = walk_steps(data, *state, with).rows_of(with).squaredNorm();
  const double evidence = before.rows() * std::log(errors.squaredNorm() / left);
  return std::isfinite(evidence) ? std::max(0.0, evidence) : 0.0;
}

bool cuts_a_walk(const Problem& problem, const Fit& fit, std::size_t effect) {
  return against_a_walk(problem, fit, effect) <= 0.0;
}

double most_evidence(Problem& problem, const Fit& fit, std::size_t effect) {
  const double against = against_a_walk(problem, fit, effect);
  if (!std::isfinite(against)) return against;
  const double evidence = evidence_on_walk(problem, fit, effect);
  const auto numbers = static_cast<double>(fit.effects[effect].coordinates.size());
  return evidence - numbers * std::log1p(evidence) + kAgainstWalk * std::max(0.0, against);
}

}  // namespace mpm
