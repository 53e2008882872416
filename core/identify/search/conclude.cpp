#include "core/identify/search/conclude.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/search/odds.hpp"
#include "core/identify/search/trial.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// An offset is one beyond so many s.d. of the noise, and of its own estimate.
constexpr double kOffsetInNoise = 1.5;
constexpr double kOffsetInSd = 6.0;

/// Cost of the CVs that an effect touches with one of its coordinates held `off` from its value.
double cost_at(Problem& problem, const Fit& fit, std::size_t effect, Index coordinate, double off) {
  std::vector<Effect> effects = fit.effects;
  std::rotate(effects.begin() + static_cast<std::ptrdiff_t>(effect),
              effects.begin() + static_cast<std::ptrdiff_t>(effect) + 1, effects.end());
  Coordinate& held = effects.back().coordinates[static_cast<std::size_t>(coordinate)];
  held.value = std::clamp(held.value + off, held.low, held.high);
  held.prior_mean = held.value;
  held.prior_sd *= 1e-6;
  const std::vector<int> cvs = touched(effects.back(), problem);
  return problem.fit(effects, effects.size() - 1, cvs, 3).cost;
}

}  // namespace

void widen_kinked(Problem& problem, SearchResult& result, const std::function<void()>& tell) {
  constexpr double kRise = 3.84;  // chi square, 1 degree of freedom
  Index first = 0;
  for (std::size_t e = 0; e < result.fit.effects.size(); ++e) {
    const Effect& effect = result.fit.effects[e];
    const auto count = static_cast<Index>(effect.coordinates.size());
    const bool kinked =
        effect.subject.cause == Cause::kStiction || effect.subject.kind == "deadband" ||
        (effect.subject.cause == Cause::kInputNonlinearity && effect.subject.kind == "saturation");
    for (Index i = 0; kinked && i < std::min<Index>(2, count); ++i) {
      double& variance = result.fit.covariance(first + i, first + i);
      const double sd = std::max(std::sqrt(variance),
                                 1e-3 * effect.coordinates[static_cast<std::size_t>(i)].prior_sd);
      tell();
      const double least = cost_at(problem, result.fit, e, i, 0.0);
      double reach = 0.0;
      for (const double side : {-1.0, 1.0})
        for (const double steps : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0, 20.0})
          if (cost_at(problem, result.fit, e, i, side * steps * sd) < least + kRise)
            reach = std::max(reach, steps * sd);
      variance = std::max(variance, reach * reach / kRise);
    }
    first += count;
  }
}

void name_levels(const Problem& problem, SearchResult& result) {
  for (CvFit& fit : result.fit.cvs) {
    // An input that the model left out has an operating point that nobody knows.
    const bool new_input =
        std::any_of(result.named.begin(), result.named.end(), [&](const Named& named) {
          return named.effect.subject.cause == Cause::kUnmodelledInput &&
                 named.effect.subject.cv == fit.cv;
        });
    if (new_input) continue;
    const CvData& data = problem.data(fit.cv);
    const double level = data.nuisances(0, 0) * fit.beta(0);
    const double noise = std::sqrt(fit.residual.squaredNorm() / std::max(1.0, data.known.sum()));
    const double memory = std::max(0.02, 1.0 - fit.noise.coefficients.sum());
    const double rows = std::max(1.0, independence({fit}) * data.rows);
    const double sd = std::sqrt(fit.variance / rows) / memory;
    if (!(std::abs(level) > kOffsetInNoise * noise && std::abs(level) > kOffsetInSd * sd)) continue;
    Named named;
    named.effect.subject = {Cause::kOutputDisturbance, fit.cv, -1, -1, "step"};
    named.effect.coordinates = {{"size", level, 0.0, noise, 0.01 * noise, -1e300, 1e300}};
    named.evidence = level * level / (sd * sd);
    named.confidence = 0.99;
    const Index old = result.fit.covariance.rows();
    result.fit.covariance.conservativeResize(old + 1, old + 1);
    result.fit.covariance.col(old).setZero();
    result.fit.covariance.row(old).setZero();
    result.fit.covariance(old, old) = sd * sd;
    result.fit.effects.push_back(named.effect);
    result.named.push_back(std::move(named));
    fit.beta(0) = 0.0;
  }
}

}  // namespace mpm
