#include "core/identify/diagnosis/selection.hpp"

#include <algorithm>
#include <numeric>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/extension.hpp"
#include "core/identify/diagnosis/validation.hpp"

namespace mpm {

using Eigen::VectorXd;

namespace {

/// How much better the CVs that an effect touches are with it, each in its own s.d. of error.
CvScore gain_of(const Effect& effect, const ModelSpec& with, const ModelSpec& without,
                const ModelSpec& model, Unseen& unseen, std::uint64_t seed) {
  VectorXd old_errors = VectorXd::Zero(unseen.rows()), new_errors = old_errors;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    if (!touches(effect, model, cv)) continue;
    const VectorXd measured = unseen.measured(cv);
    const VectorXd new_error = (measured - unseen.simulated(with, cv)).cwiseAbs2();
    const VectorXd old_error = (measured - unseen.simulated(without, cv)).cwiseAbs2();
    const double scale = mean_of_finite(new_error);
    old_errors += old_error / scale;
    new_errors += new_error / scale;
  }
  return score_errors(old_errors, new_errors, unseen.block(), seed);
}

}  // namespace

Selection select(const Problem& problem, const SearchResult& found, Unseen& unseen,
                 const std::function<void()>& tell) {
  const std::vector<bool> keep(static_cast<std::size_t>(problem.model().cv_count), true);
  Selection selection;
  selection.order.resize(found.named.size());
  std::iota(selection.order.begin(), selection.order.end(), std::size_t{0});
  std::sort(selection.order.begin(), selection.order.end(), [&](std::size_t a, std::size_t b) {
    return found.named[a].evidence < found.named[b].evidence;
  });
  for (const Named& named : found.named)
    selection.fates.push_back(causes::is_unnamed(cause_of(named.effect)) ? Fate::kNoBetter
                                                                         : Fate::kRepaired);
  for (const std::size_t i : selection.order) {
    tell();
    const Effect& effect = found.named[i].effect;
    if (effect.certain || selection.fates[i] != Fate::kRepaired) continue;
    const ModelSpec with = extend(problem, found, repaired(selection), keep);
    selection.fates[i] = Fate::kNoBetter;
    const ModelSpec without = extend(problem, found, repaired(selection), keep);
    const CvScore gain = gain_of(effect, with, without, problem.model(), unseen, unseen.seed() + i);
    if (gain.gain_low > 0.0)
      selection.fates[i] = Fate::kRepaired;
    else if (!(gain.rmse_after < gain.rmse_before))
      selection.fates[i] = Fate::kRefused;
  }
  return selection;
}

std::vector<bool> repaired(const Selection& selection) {
  std::vector<bool> in;
  for (const Fate fate : selection.fates) in.push_back(fate == Fate::kRepaired);
  return in;
}

}  // namespace mpm
