#include "core/identify/diagnosis/statement.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Where an effect's coordinates begin in the covariance of a fit with all effects free.
Index first_coordinate(const Fit& fit, std::size_t effect) {
  Index first = 0;
  for (std::size_t e = 0; e < effect; ++e)
    first += static_cast<Index>(fit.effects[e].coordinates.size());
  return first;
}

}  // namespace

Parameter stated(const Coordinate& c, double reach, double sample_time_s) {
  // No further than the model's form goes, or to 0, for "nothing": no time constant is negative.
  const double low = std::max(c.value - reach, std::min({c.low, c.value, 0.0})) + 0.0;  // never -0
  const double high = std::min(c.value + reach, std::max(c.high, c.value));
  switch (c.quantity->form) {
    case Form::kLog:
      return {c.quantity, std::exp(c.value), std::exp(low), std::exp(high), c.number};
    case Form::kSamples:
      return {c.quantity, c.value * sample_time_s, low * sample_time_s, high * sample_time_s,
              c.number};
    case Form::kPlain:
      break;
  }
  return {c.quantity, c.value, low, high, c.number};
}

Finding to_finding(const SearchResult& found, std::size_t index, const Problem& problem) {
  const Named& named = found.named[index];
  const Effect& effect = named.effect;
  Finding finding;
  finding.subject = subject_of(effect);
  finding.evidence = named.evidence;
  finding.confidence = named.confidence / (1.0 + named.confidence * cause_of(effect).alike());
  finding.rivals = named.rivals;
  const double sample_time_s = problem.surroundings().sample_time_s;
  const Index first = first_coordinate(found.fit, index);
  for (std::size_t i = 0; i < effect.coordinates.size(); ++i) {
    const Index at = first + static_cast<Index>(i);
    const double sd = std::sqrt(std::max(0.0, found.fit.covariance(at, at)));
    finding.parameters.push_back(
        stated(effect.coordinates[i], kFittedNoiseReach * sd, sample_time_s));
  }
  finding.other_input = effect.other_input;
  if (effect.onset > 0)
    finding.onset_s =
        problem.surroundings().start_s + static_cast<double>(effect.onset) * sample_time_s;
  cause_of(effect).restate(effect, problem, finding);
  return finding;
}

Unexplained to_unexplained(const SearchResult& found, std::size_t index, Problem& problem) {
  const Effect& effect = found.named[index].effect;
  Unexplained left;
  left.subject = subject_of(effect);
  const int cv = effect.place.cv;
  const auto of_cv = [&](const CvFit& fit) { return fit.cv == cv; };
  const auto fit = std::find_if(found.fit.cvs.begin(), found.fit.cvs.end(), of_cv);
  std::vector<Effect> others = found.fit.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(index));
  const VectorXd change = problem.simulate(found.fit.effects, cv) - problem.simulate(others, cv);
  const CvData& data = problem.data(cv);
  const double rows = std::max(1.0, data.known.sum());
  const double mean = change.dot(data.known) / rows;
  const double made = ((change.array() - mean).square() * data.known.array()).sum();
  left.share = made / (made + fit->residual.squaredNorm());
  // Odds on the scale of a log likelihood ratio, with all that it was picked from paid for.
  const auto numbers = static_cast<double>(effect.coordinates.size());
  left.p_value = f_upper_tail(std::max(0.0, found.named[index].evidence) / numbers, numbers, rows);
  return left;
}

}  // namespace mpm
