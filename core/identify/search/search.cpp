#include "core/identify/search/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/fit/calibration.hpp"
#include "core/identify/search/calibration.hpp"
#include "core/identify/search/conclude.hpp"
#include "core/identify/search/jumps_together.hpp"
#include "core/identify/search/odds.hpp"
#include "core/identify/search/refine.hpp"
#include "core/identify/search/screening.hpp"
#include "core/identify/search/trial.hpp"
#include "core/identify/search/walk_odds.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// The same cause at the same place, with the same numbers.
bool same_form(const Effect& a, const Effect& b) {
  const auto same_number = [](const Coordinate& x, const Coordinate& y) {
    return x.quantity == y.quantity && x.number == y.number;
  };
  return subject_of(a) == subject_of(b) && (a.onset > 0) == (b.onset > 0) &&
         a.variant == b.variant && a.other_input == b.other_input &&
         std::equal(a.coordinates.begin(), a.coordinates.end(), b.coordinates.begin(),
                    b.coordinates.end(), same_number);
}

/// At once, and to stay.
bool is_plain_jump(const Effect& effect) {
  return effect.edit->jumps() && effect.coordinates.size() == 1;
}

void erase_at(std::vector<Effect>& effects, std::size_t index) {
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(index));
}

class Search {
 public:
  Search(Problem& problem, const SearchSettings& settings)
      : problem_(problem),
        settings_(settings),
        trials_(problem, settings_, accepted_, [this] { report(); }) {}

  SearchResult run() {
    for (const Cause* cause : causes::all())
      for (const Effect& effect :
           settings_.shown ? cause->shown_by(problem_) : std::vector<Effect>{}) {
        accepted_.push_back(effect);
        named_.push_back({effect, kSeenInData, 1.0, {}});
      }
    int rounds = settings_.max_findings;
    for (;;) {
      for (; rounds > 0; --rounds) {
        share_ = std::max(share_, 0.9 - 0.8 * rounds / settings_.max_findings);
        report();
        if (!find_one() && !find_jumps()) break;
      }
      const int dropped = drop_superfluous();
      if (dropped == 0) break;
      rounds += dropped;
    }
    rewrite();
    SearchResult result = conclude();
    std::vector<CvData> settled = problem_.settled();
    result.suspect = suspect();
    problem_.settle(std::move(settled));
    result.doubted = doubted_;
    return result;
  }

  /// What was found, without those that are `out`.
  SearchResult run_without(const SearchResult& found, const std::vector<bool>& out) {
    for (std::size_t i = 0; i < found.named.size(); ++i) {
      const Effect& effect = found.named[i].effect;
      const bool offset = causes::is_constant_offset(effect);
      if (offset && out[i]) no_level_.push_back(effect.place.cv);
      if (out[i] || offset) continue;  // those that stay are named again in the end
      accepted_.push_back(found.named[i].effect);
      named_.push_back(found.named[i]);
    }
    drop_superfluous(0);
    SearchResult result = conclude();
    result.suspect = found.suspect;
    result.doubted = found.doubted;
    return result;
  }

 private:
  SearchResult conclude() {
    SearchResult result;
    result.fit = everything();
    for (std::size_t i = 0; i < accepted_.size(); ++i) {
      named_[i].effect = result.fit.effects[i];
      result.named.push_back(named_[i]);
    }
    widen_kinked(problem_, result, [this] { report(); });
    spread_onsets(problem_, result, [this] { report(); });
    std::vector<int> doubted;
    for (const int cv : all_cvs())
      if (!may_name(causes::constant_offset(cv, 0.0, 1.0)) && !has_error(cv)) doubted.push_back(cv);
    name_levels(problem_, no_level_, doubted, result);
    return result;
  }

  /// May throw, to end it all.
  void report() const {
    if (settings_.progress) settings_.progress(share_);
  }

  /// Where something was found and then was not needed beside the rest, nothing is looked for
  /// again: the rounds that it took are given back to the other CVs.
  [[nodiscard]] bool is_settled(const Effect& effect) const {
    return std::any_of(superfluous_.begin(), superfluous_.end(),
                       [&](const Effect& dropped) { return dropped.place.cv == effect.place.cv; });
  }

  /// A jump that was not needed beside the rest may be needed beside others of its CV; those that
  /// were found so are not looked for a second time.
  [[nodiscard]] bool may_jump_with_others(int cv) const {
    if (std::find(jumped_.begin(), jumped_.end(), cv) != jumped_.end()) return false;
    return std::all_of(superfluous_.begin(), superfluous_.end(), [&](const Effect& dropped) {
      return dropped.place.cv != cv || dropped.edit->jumps();
    });
  }

  /// Odds that an effect must have to be accepted.
  [[nodiscard]] double needed(const Effect& effect) const {
    const bool another =
        effect.edit->jumps() &&
        std::any_of(accepted_.begin(), accepted_.end(), [&](const Effect& other) {
          return other.edit->jumps() && other.onset > 0 && other.place == effect.place;
        });
    return another ? std::max(settings_.decisive, kAnotherJump) : settings_.decisive;
  }

  [[nodiscard]] bool may_name(const Effect& effect) const {
    return !settings_.may_name || settings_.may_name(effect);
  }

  /// Whether something of the CV's channels is named, beside which its level can be told.
  [[nodiscard]] bool has_error(int cv) const {
    return std::any_of(accepted_.begin(), accepted_.end(), [&](const Effect& effect) {
      return cause_of(effect).acts_through_channels() && touches(effect, problem_.model(), cv);
    });
  }

  /// All that may still be wrong, each cause's starts: what may be named, or what may not.
  [[nodiscard]] std::vector<Effect> proposals(bool nameable) {
    std::vector<Effect> all;
    const auto& causes = causes::all();
    std::vector<std::vector<Effect>> of_each(causes.size());
    if (nameable) jumps_.clear();
    trials_.parallel().for_each(causes.size(), [&](std::size_t i) {
      causes[i]->propose({problem_, accepted_, nulls_, trials_.parallel()}, of_each[i]);
    });
    for (std::size_t i = 0; i < causes.size(); ++i) {
      const Cause* cause = causes[i];
      if (cause->is_curve() && !settings_.curves) continue;
      for (Effect& effect : of_each[i]) {
        if (may_name(effect) != nameable) continue;
        const bool open =
            std::all_of(accepted_.begin(), accepted_.end(),
                        [&](const Effect& accepted) { return cause->goes_with(accepted, effect); });
        if (!open) continue;
        if (nameable && is_plain_jump(effect)) jumps_.try_emplace(effect.place.cv, effect);
        if (!nameable || !is_settled(effect)) all.push_back(std::move(effect));
      }
    }
    return all;
  }

  std::vector<Effect> shortlist(bool nameable) {
    nulls_.resize(static_cast<std::size_t>(problem_.model().cv_count));
    trials_.parallel().for_each(nulls_.size(), [&](std::size_t cv) {
      nulls_[cv] = trials_.without({static_cast<int>(cv)}).cvs.front();
    });
    const std::vector<Effect> all = proposals(nameable);
    const Screening& screening = screening_.emplace(problem_, accepted_, nulls_);
    std::vector<double> scores(all.size());
    trials_.parallel().for_each(all.size(), [&](std::size_t i) {
      trials_.tell();
      scores[i] = screening.score(all[i]) - cause_of(all[i]).rarity();
    });
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    std::vector<Effect> list;
    std::map<const CauseName*, int> of_cause;
    std::size_t passing = 0;  // beside the others, of whose places they take none
    for (const std::size_t i : order) {
      const auto repeats = std::count_if(list.begin(), list.end(), [&](const Effect& effect) {
        return same_form(effect, all[i]);
      });
      if (repeats >= kStartsOfOneForm) continue;
      if (causes::passes(all[i])) {
        if (passing == kOfEachCause || scores[i] < kHopelessOfCause) continue;
        ++passing;
        list.push_back(all[i]);
        continue;
      }
      int& likes = of_cause[&cause_of(all[i]).name()];
      const bool first_of_cause = likes < kOfEachCause && scores[i] > kHopelessOfCause;
      if (scores[i] < kHopeless || (list.size() - passing >= kShortlist && !first_of_cause))
        continue;
      ++likes;
      list.push_back(all[i]);
    }
    return list;
  }

  bool find_one() {
    doubted_.reset();
    trials_.settle(last_.cvs.empty() ? nullptr : &last_);
    std::vector<Trial> trials = trials_.attempt_all(shortlist(true), kTrialSteps);
    if (trials.empty()) return false;
    std::sort(trials.begin(), trials.end(), more_probable);
    look_closer(trials_, *screening_, trials);
    std::erase_if(trials, [this](const Trial& trial) {
      return !may_name(trial.candidate) || spreads_a_cv(trial);
    });
    if (trials.empty()) return false;
    std::sort(trials.begin(), trials.end(), more_probable);
    // The best one first: how far behind the others are decides whether they are worth it.
    refine(trials[0], trials[0]);
    trials_.parallel().for_each(std::min(kRefined, trials.size()) - 1, [&](std::size_t i) {
      share_onset(trials_, trials[0], trials[i + 1]);
      refine(trials[i + 1], trials[0]);
    });
    std::sort(trials.begin(), trials.end(), more_probable);
    while (!trials.empty() && trials[0].odds >= settings_.decisive) {
      std::vector<Trial> again = once_more(trials);
      if (again[0].odds >= needed(again[0].candidate)) {
        accept(again);
        return true;
      }
      const Effect& best = trials[0].candidate;
      if (!best.edit->jumps()) return false;
      // A shock of the noise is no jump, nor any other function of time: what else there is may
      // have been hidden by it.
      if (!doubted_) doubted_ = Named{best, trials[0].odds, 0.0, {}};
      const int cv = best.place.cv;
      std::erase_if(trials, [cv](const Trial& trial) {
        return causes::is_break(trial.candidate) && trial.candidate.place.cv == cv;
      });
    }
    return false;
  }

  /// Jumps of one CV of which none is decisive beside the others.
  bool find_jumps() {
    std::vector<CvData> settled = problem_.settled();
    for (const auto& [cv, jump] : jumps_) {
      if (!may_jump_with_others(cv)) continue;
      const std::vector<Trial> found = jumps_together(trials_, jump, settings_.decisive);
      for (const Trial& trial : found) accept({trial});
      if (found.empty()) continue;
      jumped_.push_back(cv);
      return true;
    }
    problem_.settle(std::move(settled));
    return false;
  }

  /// The best trials beside rows that are weighed as the best explanation's innovations ask for. A
  /// shock in the noise would vanish with a jump fitted to it, so a jump has to do without that
  /// row's help.
  std::vector<Trial> once_more(const std::vector<Trial>& trials) {
    const bool jump = trials[0].candidate.edit->jumps();
    const Fit weighing =
        jump ? trials_.without(touched(trials[0].candidate, problem_)) : trials[0].fit;
    trials_.settle(&weighing);
    std::vector<Effect> best;
    for (std::size_t i = 0; i < std::min(kTriedAgain, trials.size()); ++i) {
      best.push_back(trials[i].candidate);
      Effect& effect = best.back();
      if (jump && told_by_shock(effect, weighing))
        effect.search_cost = std::min(effect.search_cost, cost_of_cvs());
    }
    std::vector<Trial> again = trials_.attempt_all(best, kSecondTrialSteps);
    std::sort(again.begin(), again.end(), more_probable);
    return again;
  }

  [[nodiscard]] double cost_of_cvs() const {
    return cost_of(static_cast<std::size_t>(problem_.model().cv_count));
  }

  /// Whether a step stands where the CV has by far its largest shock, which then tells the moment
  /// whatever comes after it: among all moments nobody had to search.
  [[nodiscard]] static bool told_by_shock(const Effect& effect, const Fit& without) {
    return is_plain_jump(effect) && effect.onset > 0 &&
           std::any_of(without.cvs.begin(), without.cvs.end(), [&](const CvFit& state) {
             if (state.cv != effect.place.cv) return false;
             const Eigen::Index behind =
                 std::min(effect.onset + kShockRows, state.innovations.size());
             const double others =
                 std::max(state.innovations.head(effect.onset).lpNorm<Eigen::Infinity>(),
                          state.innovations.tail(state.innovations.size() - behind)
                              .lpNorm<Eigen::Infinity>());
             return std::abs(state.innovations(effect.onset)) > kLargestShock * others;
           });
  }

  /// Whether what an actuator is said to do to all its CVs moves one of them that did not move so:
  /// a noise that wanders takes the level that it leaves there for its own.
  [[nodiscard]] bool spreads_a_cv(const Trial& trial) {
    const Effect& effect = trial.candidate;
    if (effect.place.cv >= 0 || cause_of(effect).acts_through_channels()) return false;
    const Fit& without = trials_.without(touched(effect, problem_));
    const auto spread = [this](const CvFit& fit) {
      const Eigen::VectorXd left = left_of(problem_.data(fit.cv), fit);
      double sum = 0.0, square = 0.0, count = 0.0;
      for (const double value : left)
        if (std::isfinite(value)) sum += value, square += value * value, ++count;
      return square - sum * sum / std::max(count, 1.0);
    };
    return std::any_of(trial.fit.cvs.begin(), trial.fit.cvs.end(), [&](const CvFit& with) {
      const auto same = std::find_if(without.cvs.begin(), without.cvs.end(),
                                     [&](const CvFit& fit) { return fit.cv == with.cv; });
      return same != without.cvs.end() && spread(with) > kSpreads * spread(*same);
    });
  }

  void refine(Trial& trial, const Trial& best) {
    if (trial.candidate.onset > 0 && trial.odds > best.odds - kOnsetWorthMoving)
      place_onset(trials_, trial);
    if (trial.odds > kWorthStepping * best.odds) step_about(trials_, trial);
  }

  /// The best of what may not be named, beside all that was.
  std::optional<Named> suspect() {
    if (!settings_.may_name || !settings_.suspects) return std::nullopt;
    trials_.settle(last_.cvs.empty() ? nullptr : &last_);
    std::optional<Named> best;
    for (const Trial& trial : trials_.attempt_all(shortlist(false), kTrialSteps)) {
      if (trial.odds < settings_.decisive || (best && best->evidence >= trial.odds)) continue;
      best = Named{trial.candidate, trial.odds, 0.0, {}};
    }
    return best;
  }

  void accept(const std::vector<Trial>& trials) {
    const Trial& best = trials[0];
    Named named;
    named.evidence = best.odds;
    double total = 1.0 + std::exp(-0.5 * best.odds);
    for (std::size_t i = 1; i < trials.size(); ++i) {
      const Subject subject = subject_of(trials[i].candidate);
      if (subject == subject_of(best.candidate)) continue;
      const bool known = std::any_of(named.rivals.begin(), named.rivals.end(),
                                     [&](const Rival& r) { return r.subject == subject; });
      if (known || !share_a_cv(best.candidate, trials[i].candidate)) continue;
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
        if (same_form(effect, other) && effect.onset == other.onset) effect = other;
    accepted_.push_back(best.candidate);
    last_ = best.fit;
    merge();
  }

  /// What happens to another CV is no other explanation of this one: it may be so besides.
  [[nodiscard]] bool share_a_cv(const Effect& a, const Effect& b) const {
    const std::vector<int> cvs = touched(a, problem_);
    return std::any_of(cvs.begin(), cvs.end(),
                       [&](int cv) { return touches(b, problem_.model(), cv); });
  }

  /// Says what was accepted with fewer parts wrong, where a cause knows how and that explains the
  /// data no worse.
  void rewrite() {
    while (rewrite_one()) report();
  }

  bool rewrite_one() {
    for (std::size_t i = 0; i < accepted_.size(); ++i)
      for (const Rewrite& rewrite :
           cause_of(accepted_[i]).rewrites(i, accepted_, problem_, settings_.materiality))
        if (std::all_of(rewrite.with.begin(), rewrite.with.end(),
                        [this](const Effect& effect) { return may_name(effect); }) &&
            take(rewrite, i))
          return true;
    return false;
  }

  /// The effects that come in stand for the one at `mine`, which stays as their rival.
  bool take(const Rewrite& rewrite, std::size_t mine) {
    const std::vector<Effect> old_effects = accepted_;
    const std::vector<Named> old_named = named_;
    const double old_cost = everything().cost;
    for (std::size_t k = rewrite.without.size(); k-- > 0;) {  // the last ones first
      erase_at(accepted_, rewrite.without[k]);
      named_.erase(named_.begin() + static_cast<std::ptrdiff_t>(rewrite.without[k]));
    }
    const std::size_t first_new = named_.size();
    for (const Effect& effect : rewrite.with) {
      accepted_.push_back(effect);
      named_.push_back(old_named[mine]);
    }
    const double worse = everything().cost - old_cost;
    if (worse > settings_.decisive) {
      accepted_ = old_effects;
      named_ = old_named;
      return false;
    }
    for (std::size_t i = first_new; i < named_.size(); ++i)
      named_[i].rivals = {{subject_of(old_effects[mine]), std::max(0.0, -worse), true}};
    return true;
  }

  /// Errors of one channel found one after the other are one finding.
  void merge() {
    const Effect& last = accepted_.back();
    const Cause* together = cause_of(last).together_with_others();
    if (together == nullptr) return;
    for (std::size_t i = 0; i + 1 < accepted_.size(); ++i) {
      Effect& other = accepted_[i];
      if (cause_of(other).together_with_others() != together || other.place != last.place ||
          other.onset != last.onset)
        continue;
      for (const Coordinate& coordinate : last.coordinates) {
        const Coordinate* same = other.find(*coordinate.quantity);
        if (same == nullptr) {
          other.coordinates.push_back(coordinate);
        } else {
          Coordinate& own =
              other.coordinates[static_cast<std::size_t>(same - other.coordinates.data())];
          own.value = own.quantity->form == Form::kPlain ? own.value * coordinate.value
                                                         : own.value + coordinate.value;
        }
      }
      if (other.coordinates.size() > 1) other.edit = together;
      named_[i].evidence += named_.back().evidence;
      accepted_.pop_back();
      named_.pop_back();
      return;
    }
  }

  [[nodiscard]] std::vector<int> all_cvs() const {
    std::vector<int> cvs(static_cast<std::size_t>(problem_.model().cv_count));
    std::iota(cvs.begin(), cvs.end(), 0);
    return cvs;
  }

  Fit everything() { return problem_.fit(accepted_, 0, all_cvs(), kJointSteps); }

  /// How many.
  int drop_superfluous(std::size_t fewest = 1) {
    const std::size_t before = accepted_.size();
    bool dropped = accepted_.size() > fewest;
    while (dropped && accepted_.size() > fewest) {
      dropped = false;
      const Fit all = everything();
      for (std::size_t i = 0; i < accepted_.size() && !dropped; ++i) {
        report();
        if (all.effects[i].certain) continue;
        std::vector<Effect> fewer = all.effects;
        erase_at(fewer, i);
        const double odds =
            trials_.odds_of(all, i, problem_.fit(fewer, 0, all_cvs(), kWithoutOneSteps));
        named_[i].evidence = odds;
        // Of two that say the same one is enough.
        const auto same =
            std::count_if(all.effects.begin(), all.effects.end(),
                          [&](const Effect& other) { return same_form(other, all.effects[i]); });
        const bool slow = same == 1 && cause_of(all.effects[i]).may_pass_for_noise() &&
                          !cuts_a_walk(problem_, all, i);
        if (odds >= (slow ? kWanderingNoise : settings_.decisive)) continue;
        superfluous_.push_back(all.effects[i]);
        accepted_ = std::move(fewer);
        named_.erase(named_.begin() + static_cast<std::ptrdiff_t>(i));
        dropped = true;
      }
      if (!dropped) accepted_ = all.effects;
    }
    return static_cast<int>(before - accepted_.size());
  }

  Problem& problem_;
  SearchSettings settings_;
  double share_ = 0.0;  // of the work done, as last told
  std::vector<Effect> accepted_;
  std::vector<Named> named_;
  std::vector<Effect> superfluous_;  // found, and then not needed beside the rest
  std::vector<int> no_level_;        // CVs of which no constant offset is to be named
  Trials trials_;
  std::optional<Named> doubted_;
  std::map<int, Effect> jumps_;  // of this round, by CV: where it may jump, whatever is settled
  std::vector<int> jumped_;      // CVs whose jumps were found together
  std::vector<CvFit> nulls_;     // of this round, one per CV; what the screening looks at
  std::optional<Screening> screening_;
  Fit last_;
};

}  // namespace

SearchResult search(Problem& problem, const SearchSettings& settings) {
  return Search(problem, settings).run();
}

SearchResult without(Problem& problem, const SearchResult& found, const std::vector<bool>& out,
                     const SearchSettings& settings) {
  return Search(problem, settings).run_without(found, out);
}

}  // namespace mpm
