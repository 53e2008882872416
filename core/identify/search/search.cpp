#include "core/identify/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "core/identify/causes/candidates.hpp"
#include "core/identify/causes/unnamed.hpp"
#include "core/identify/search/conclude.hpp"
#include "core/identify/search/odds.hpp"
#include "core/identify/search/refine.hpp"
#include "core/identify/search/screening.hpp"
#include "core/identify/search/trial.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// Candidates fitted in full in every round, beside the best of each cause.
constexpr std::size_t kShortlist = 16;
/// 2 ln odds of what the data themselves show.
constexpr double kCertain = 1000.0;

bool same_variant(const Effect& a, const Effect& b) {
  if (!(a.subject == b.subject) || a.coordinates.size() != b.coordinates.size() ||
      (a.onset > 0) != (b.onset > 0) || a.slips_once != b.slips_once)
    return false;
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    if (a.coordinates[i].name != b.coordinates[i].name) return false;
  return true;
}

class Search {
 public:
  Search(Problem& problem, const SearchSettings& settings)
      : problem_(problem),
        settings_(settings),
        trials_(problem, settings_, accepted_, [this] { report(); }) {}

  SearchResult run() {
    for (const Effect& effect : problem_.clipping()) {
      accepted_.push_back(effect);
      named_.push_back({effect, kCertain, 1.0, {}});
    }
    for (int round = 0; round < settings_.max_findings; ++round) {
      share_ = 0.1 + 0.8 * round / settings_.max_findings;
      report();
      if (!find_one()) break;
    }
    drop_superfluous();
    undo_cancelled_scales();
    SearchResult result;
    result.fit = everything();
    for (std::size_t i = 0; i < accepted_.size(); ++i) {
      named_[i].effect = result.fit.effects[i];
      result.named.push_back(named_[i]);
    }
    widen_kinked(problem_, result, [this] { report(); });
    name_levels(problem_, result);
    return result;
  }

 private:
  /// May throw, to end it all.
  void report() const {
    if (settings_.progress) settings_.progress(share_);
  }

  std::vector<Effect> shortlist() {
    std::vector<CvFit>& nulls = nulls_;
    nulls.clear();
    for (int cv = 0; cv < problem_.model().cv_count; ++cv)
      nulls.push_back(trials_.without({cv}).cvs.front());
    std::vector<Effect> all = candidates(problem_, accepted_);
    for (const CvFit& null : nulls) {
      for (Effect& effect : disturbance_candidates(problem_, null))
        all.push_back(std::move(effect));
      for (Effect& effect : unnamed_candidates(problem_, accepted_, null))
        all.push_back(std::move(effect));
    }
    Screening& screening = screening_.emplace(problem_, accepted_, nulls);
    std::vector<double> scores;
    for (const Effect& effect : all) {
      report();
      scores.push_back(screening.score(effect) - rarity(effect.subject.cause));
    }
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    std::vector<Effect> list;
    std::map<Cause, int> of_cause;
    for (const std::size_t i : order) {
      const auto repeats = std::count_if(list.begin(), list.end(), [&](const Effect& effect) {
        return same_variant(effect, all[i]);
      });
      if (repeats >= 2) continue;
      const bool first_of_cause = of_cause[all[i].subject.cause] < 2 && scores[i] > -15.0;
      if (scores[i] < -20.0 || (list.size() >= kShortlist && !first_of_cause)) continue;
      ++of_cause[all[i].subject.cause];
      list.push_back(all[i]);
    }
    return list;
  }

  bool find_one() {
    trials_.settle(last_.cvs.empty() ? nullptr : &last_);
    std::vector<Trial> trials;
    for (const Effect& effect : shortlist()) trials.push_back(trials_.attempt(effect, 6));
    if (trials.empty()) return false;
    std::sort(trials.begin(), trials.end(), more_probable);
    try_valves(trials_, *screening_, trials);
    std::sort(trials.begin(), trials.end(), more_probable);
    for (std::size_t i = 0; i < std::min<std::size_t>(6, trials.size()); ++i) {
      if (trials[i].candidate.onset > 0 && trials[i].odds > trials[0].odds - 60.0)
        place_onset(trials_, trials[i]);
      if (trials[i].odds > 0.5 * trials[0].odds) polish(trials_, trials[i]);
    }
    std::sort(trials.begin(), trials.end(), more_probable);
    if (trials[0].odds < settings_.decisive) return false;

    // Once more with rows weighed as the best explanation's innovations ask for. A shock in the
    // noise would vanish with a step fitted to it, so a step has to do without that row's help.
    const bool step = trials[0].candidate.subject.kind == "step";
    const Fit weighing =
        step ? trials_.without(touched(trials[0].candidate, problem_)) : trials[0].fit;
    trials_.settle(&weighing);
    std::vector<Trial> again;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, trials.size()); ++i)
      again.push_back(trials_.attempt(trials[i].candidate, 8));
    std::sort(again.begin(), again.end(), more_probable);
    if (again[0].odds < settings_.decisive) return false;
    accept(again);
    return true;
  }

  void accept(const std::vector<Trial>& trials) {
    const Trial& best = trials[0];
    Named named;
    named.evidence = best.odds;
    double total = 1.0 + std::exp(-0.5 * best.odds);
    for (std::size_t i = 1; i < trials.size(); ++i) {
      const Subject& subject = trials[i].candidate.subject;
      if (subject == best.candidate.subject) continue;
      const bool known = std::any_of(named.rivals.begin(), named.rivals.end(),
                                     [&](const Rival& r) { return r.subject == subject; });
      if (known) continue;
      // Odds are against the same CVs without either, whichever CVs a rival touches.
      const double worse = best.odds - trials[i].odds;
      named.rivals.push_back({subject, worse, worse < settings_.decisive});
      total += std::exp(-0.5 * worse);
    }
    named.confidence = 1.0 / total;
    named_.push_back(named);
    // The fit moved the accepted effects too.
    std::vector<Effect> moved = best.fit.effects;
    for (Effect& effect : accepted_)
      for (const Effect& other : moved)
        if (same_variant(effect, other)) effect = other;
    accepted_.push_back(best.candidate);
    last_ = best.fit;
    merge();
  }

  /// A scale of a whole input together with a gain that takes it back in one CV says in two
  /// findings what gains of the other CVs say too, with fewer channels wrong: those are meant.
  void undo_cancelled_scales() {
    for (std::size_t w = 0; w < accepted_.size(); ++w) {
      if (accepted_[w].subject.cause != Cause::kInputScale) continue;
      for (std::size_t g = 0; g < accepted_.size(); ++g) {
        const Subject gain = accepted_[g].subject;
        if (gain.cause != Cause::kGain || gain.input != accepted_[w].subject.input ||
            accepted_[g].onset != accepted_[w].onset)
          continue;
        const double ratio = accepted_[w].value("gain_ratio", 1.0);
        const double left = ratio * accepted_[g].value("gain_ratio", 1.0) - 1.0;
        std::vector<int> others = touched(accepted_[w], problem_);
        std::erase(others, gain.cv);
        if (std::abs(left) > settings_.materiality.gain || others.empty() || others.size() > 2)
          continue;
        const std::vector<Effect> old_effects = accepted_;
        const std::vector<Named> old_named = named_;
        const double old_cost = everything().cost;
        Effect effect = accepted_[g];
        Named named = named_[w];
        for (const std::size_t i : {std::max(w, g), std::min(w, g)}) {
          accepted_.erase(accepted_.begin() + static_cast<std::ptrdiff_t>(i));
          named_.erase(named_.begin() + static_cast<std::ptrdiff_t>(i));
        }
        for (const int cv : others) {
          effect.subject.cv = cv;
          effect.coordinates[0].value = ratio;
          accepted_.push_back(effect);
          named_.push_back(named);
        }
        const double worse = everything().cost - old_cost;
        if (worse > settings_.decisive) {
          accepted_ = old_effects;
          named_ = old_named;
          continue;
        }
        for (std::size_t i = named_.size() - others.size(); i < named_.size(); ++i)
          named_[i].rivals = {{old_effects[w].subject, std::max(0.0, -worse), true}};
        return;
      }
    }
  }

  /// Errors of one channel found one after the other are one finding.
  void merge() {
    const auto in_channel = [](Cause cause) {
      return cause == Cause::kGain || cause == Cause::kDeadTime || cause == Cause::kTimeConstant ||
             cause == Cause::kDynamics;
    };
    Effect& last = accepted_.back();
    for (std::size_t i = 0; i + 1 < accepted_.size(); ++i) {
      Effect& other = accepted_[i];
      if (!in_channel(last.subject.cause) || !in_channel(other.subject.cause) ||
          other.subject.cv != last.subject.cv || other.subject.input != last.subject.input ||
          other.onset != last.onset)
        continue;
      for (const Coordinate& coordinate : last.coordinates) {
        const Coordinate* same = other.find(coordinate.name);
        if (!same) {
          other.coordinates.push_back(coordinate);
        } else {
          auto& own = other.coordinates[static_cast<std::size_t>(same - other.coordinates.data())];
          own.value = own.name == "gain_ratio" ? own.value * coordinate.value
                                               : own.value + coordinate.value;
        }
      }
      if (other.coordinates.size() > 1) other.subject.cause = Cause::kDynamics;
      named_[i].evidence += named_.back().evidence;
      accepted_.pop_back();
      named_.pop_back();
      return;
    }
  }

  Fit everything() {
    std::vector<int> cvs(static_cast<std::size_t>(problem_.model().cv_count));
    std::iota(cvs.begin(), cvs.end(), 0);
    return problem_.fit(accepted_, 0, cvs, 10);
  }

  void drop_superfluous() {
    bool dropped = accepted_.size() > 1;
    while (dropped && accepted_.size() > 1) {
      dropped = false;
      const Fit all = everything();
      for (std::size_t i = 0; i < accepted_.size() && !dropped; ++i) {
        report();
        if (all.effects[i].certain) continue;
        std::vector<Effect> fewer = all.effects;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
        std::vector<int> cvs(static_cast<std::size_t>(problem_.model().cv_count));
        std::iota(cvs.begin(), cvs.end(), 0);
        const double odds = odds_for(all.effects[i], all, problem_.fit(fewer, 0, cvs, 8));
        named_[i].evidence = odds;
        const bool slow = may_pass_for_noise(all.effects[i].subject);
        if (odds >= (slow ? kWanderingNoise : settings_.decisive)) continue;
        accepted_ = std::move(fewer);
        named_.erase(named_.begin() + static_cast<std::ptrdiff_t>(i));
        dropped = true;
      }
      if (!dropped) accepted_ = all.effects;
    }
  }

  Problem& problem_;
  SearchSettings settings_;
  double share_ = 0.0;  // of the work done, as last told
  std::vector<Effect> accepted_;
  std::vector<Named> named_;
  Trials trials_;
  std::vector<CvFit> nulls_;  // of this round, one per CV; what the screening looks at
  std::optional<Screening> screening_;
  Fit last_;
};

}  // namespace

SearchResult search(Problem& problem, const SearchSettings& settings) {
  return Search(problem, settings).run();
}

}  // namespace mpm
