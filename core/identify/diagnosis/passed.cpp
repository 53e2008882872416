#include "core/identify/diagnosis/passed.hpp"

#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/noise_choice.hpp"
#include "core/identify/diagnosis/selection.hpp"
#include "core/identify/diagnosis/setpoint_rival.hpp"
#include "core/identify/diagnosis/statement.hpp"

namespace mpm {

std::vector<int> without_a_name(const Account& kept, const ModelSpec& model) {
  std::vector<int> cvs;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const auto acts = [&](const Effect& effect) { return touches(effect, model, cv); };
    const auto is_named = [cv](const Named& named) { return named.effect.place.cv == cv; };
    if (std::any_of(kept.refused_effects.begin(), kept.refused_effects.end(), acts) &&
        std::none_of(kept.found.named.begin(), kept.found.named.end(), is_named))
      cvs.push_back(cv);
  }
  return cvs;
}

std::vector<Finding> find_passed(const ModelSpec& model, int model_inputs, const Recording& fitted,
                                 const std::vector<int>& cvs, Unseen& unseen,
                                 const SearchSettings& asked) {
  if (cvs.empty()) return {};
  SearchSettings settings = asked;
  settings.shown = settings.suspects = false;
  settings.may_name = [&](const Effect& effect) {
    return !cause_of(effect).acts_through_channels() &&
           std::find(cvs.begin(), cvs.end(), effect.place.cv) != cvs.end() &&
           (!asked.may_name || asked.may_name(effect));
  };
  Problem problem(model, model_inputs, fitted, Tolerances{},
                  free_noise(model, model_inputs, fitted));
  const SearchResult found = search(problem, settings);
  std::vector<Finding> passed;
  for (std::size_t i = 0; i < found.named.size(); ++i) {
    const Named& named = found.named[i];
    if (!causes::passes(named.effect) || named.evidence < kStrongEvidence ||
        !has_passed(named.effect, problem, unseen) ||
        why_not_step(named.effect, found.named, model, fitted) != nullptr)
      continue;
    Finding& finding = passed.emplace_back(to_finding(found, i, problem));
    finding.repaired = false;
    finding.refused = why_not_in_model(Fate::kOver);
  }
  return passed;
}

}  // namespace mpm
