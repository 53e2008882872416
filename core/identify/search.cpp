#include "core/identify/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "core/identify/candidates.hpp"
#include "core/identify/screening.hpp"
#include "core/identify/square_waves.hpp"
#include "core/identify/unnamed.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// Candidates fitted in full in every round, beside the best of each cause.
constexpr std::size_t kShortlist = 16;
/// A cause that the noise could pass for is taken if noise models speak no more than this against
/// it, and the one fitted with it speaks for it by this much more than would do otherwise.
constexpr double kWanderingNoise = -10.0;
constexpr double kSettledNoise = 12.0;
/// An offset is one beyond so many s.d. of the noise, and of its own estimate.
constexpr double kOffsetInNoise = 1.5;
constexpr double kOffsetInSd = 6.0;
/// 2 ln odds of what the data themselves show.
constexpr double kCertain = 1000.0;

/// 2 ln of the prior odds against any one kind of cause: errors of channels are what one expects.
double rarity(Cause cause) {
  switch (cause) {
    case Cause::kGain:
    case Cause::kDeadTime:
    case Cause::kTimeConstant:
    case Cause::kDynamics:
    case Cause::kInputScale:
    case Cause::kOutputScale:
      return 0.0;
    case Cause::kStateNonlinearity:
      return 2.0 * std::log(24.0);
    case Cause::kUnnamed:  // a name is better than none
      return 2.0 * std::log(1000.0);
    default:
      return 2.0 * std::log(12.0);
  }
}

/// Slow and without an edge.
bool may_pass_for_noise(const Subject& subject) {
  return subject.cause == Cause::kUnmodelledInput || subject.kind == "drift" ||
         subject.kind == "periodic";
}

/// Share of the rows that count as independent: innovations that still hang together say less than
/// their number. 1 where the noise model whitens.
double independence(const Fit& fit) {
  double product = 0.0, square = 0.0;
  for (const CvFit& state : fit.cvs) {
    const Index rows = state.innovations.size() - 1;
    product += state.innovations.head(rows).dot(state.innovations.tail(rows)) / state.variance;
    square += state.innovations.squaredNorm() / state.variance;
  }
  const double correlation = square > 0.0 ? std::max(0.0, product / square) : 0.0;
  return correlation < 0.1 ? 1.0 : (1.0 - correlation) / (1.0 + correlation);
}

/// 2 ln of the odds for an effect: a fit with it against one without it on the same CVs.
double odds_for(const Effect& effect, const Fit& with, const Fit& without) {
  if (!std::isfinite(with.cost)) return -1e300;
  return independence(with) * (without.misfit - with.misfit) + without.complexity -
         with.complexity - effect.search_cost - rarity(effect.subject.cause);
}

bool same_variant(const Effect& a, const Effect& b) {
  if (!(a.subject == b.subject) || a.coordinates.size() != b.coordinates.size() ||
      (a.onset > 0) != (b.onset > 0) || a.slips_once != b.slips_once)
    return false;
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    if (a.coordinates[i].name != b.coordinates[i].name) return false;
  return true;
}

std::vector<int> touched(const Effect& effect, const Problem& problem) {
  std::vector<int> cvs;
  for (int cv = 0; cv < problem.model().cv_count; ++cv)
    if (touches(effect, problem.model(), cv)) cvs.push_back(cv);
  return cvs;
}

/// A candidate, fitted with the accepted effects that live on its CVs alone.
struct Trial {
  Effect candidate;
  Fit fit;            ///< effects: the frozen ones, the accepted free ones, the candidate last
  double odds = 0.0;  ///< 2 ln
  double settled_odds = 0.0;
};

class Search {
 public:
  Search(Problem& problem, const SearchSettings& settings)
      : problem_(problem), settings_(settings) {}

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
    widen_kinked(result);
    name_levels(result);
    return result;
  }

 private:
  /// May throw, to end it all.
  void report() const {
    if (settings_.progress) settings_.progress(share_);
  }

  /// Accepted effects that touch other CVs too come first and stay; returns how many.
  std::size_t arrange(const std::vector<int>& cvs, std::vector<Effect>& effects) const {
    std::vector<Effect> frozen, free;
    for (const Effect& effect : accepted_) {
      const std::vector<int> own = touched(effect, problem_);
      const bool inside = std::includes(cvs.begin(), cvs.end(), own.begin(), own.end());
      (inside ? free : frozen).push_back(effect);
    }
    const std::size_t first_free = frozen.size();
    effects = std::move(frozen);
    effects.insert(effects.end(), free.begin(), free.end());
    return first_free;
  }

  const Fit& without(const std::vector<int>& cvs) {
    const auto found = without_.find(cvs);
    if (found != without_.end()) return found->second;
    std::vector<Effect> effects;
    const std::size_t first_free = arrange(cvs, effects);
    return without_.emplace(cvs, problem_.fit(std::move(effects), first_free, cvs)).first->second;
  }

  Trial attempt(const Effect& candidate, int iterations) {
    report();  // a round takes seconds
    Trial trial;
    trial.candidate = candidate;
    const std::vector<int> cvs = touched(candidate, problem_);
    std::vector<Effect> effects;
    const std::size_t first_free = arrange(cvs, effects);
    effects.push_back(candidate);
    trial.fit = problem_.fit(std::move(effects), first_free, cvs, iterations);
    trial.candidate = trial.fit.effects.back();
    const Fit& null = without(cvs);
    trial.odds = odds_for(candidate, trial.fit, null);
    const Cause cause = candidate.subject.cause;
    if (may_pass_for_noise(candidate.subject)) {
      // What is slow can hide in a noise model that is re-estimated without it: it then takes the
      // noise for a wandering one. So it also counts how the noise model with the cause judges the
      // lack of it.
      double rows = 0.0;
      for (const int cv : cvs) rows += problem_.data(cv).rows;
      std::vector<Effect> others = trial.fit.effects;
      others.pop_back();
      trial.settled_odds = problem_.cost_with_noise_of(trial.fit, others) - rows -
                           trial.fit.complexity - candidate.search_cost - rarity(cause);
      if (trial.odds > kWanderingNoise)
        trial.odds = std::max(trial.odds, trial.settled_odds - kSettledNoise);
    }
    if (!material(trial)) trial.odds = std::min(trial.odds, 0.0);
    return trial;
  }

  /// Whether anyone would care: an error of a channel beyond what a model may be wrong by, and for
  /// all others a visible share of what the CV does.
  bool material(const Trial& trial) {
    const Effect& effect = trial.candidate;
    const int gain = std::abs(effect.value("gain_ratio", 1.0) - 1.0) >= settings_.materiality.gain;
    const int time_constant = std::abs(effect.value("log_time_constant_ratio", 0.0)) >=
                              std::log(1.0 + settings_.materiality.log_time_constant);
    const int dead_time =
        std::abs(effect.value("dead_time_samples", 0.0)) >= settings_.materiality.dead_time_samples;
    switch (effect.subject.cause) {
      case Cause::kGain:
      case Cause::kInputScale:
      case Cause::kOutputScale:
      case Cause::kTimeConstant:
      case Cause::kDeadTime:
        return gain + time_constant + dead_time > 0;
      case Cause::kDynamics:
        return gain + time_constant + dead_time > 1;
      default:
        break;
    }
    std::vector<Effect> without = trial.fit.effects;
    without.pop_back();
    for (const CvFit& state : trial.fit.cvs) {
      const CvData& data = problem_.data(state.cv);
      const Eigen::VectorXd change =
          problem_.simulate(trial.fit.effects, state.cv) - problem_.simulate(without, state.cv);
      const double rows = std::max(1.0, data.known.sum());
      const double mean = data.measured.dot(data.known) / rows;
      const double level = change.mean();
      const double moved = (change.array() - level).square().mean();
      const double all =
          ((data.measured.array() - mean).square() * data.known.array()).sum() / rows;
      if (moved >= settings_.visible * settings_.visible * all) return true;
    }
    return false;
  }

  std::vector<Effect> shortlist() {
    std::vector<CvFit>& nulls = nulls_;
    nulls.clear();
    for (int cv = 0; cv < problem_.model().cv_count; ++cv)
      nulls.push_back(without({cv}).cvs.front());
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

  /// Moves the onset of a trial about until no other moment is better.
  void place_onset(Trial& trial) {
    const Index margin = problem_.samples() / 50 + 5;
    Index reach = std::max<Index>(2, problem_.samples() / 12);
    while (reach >= 2) {
      bool moved = false;
      for (const Effect& other : other_onsets(trial.candidate, reach, problem_.samples())) {
        Trial next = attempt(other, 4);
        if (next.odds > trial.odds + 1e-9) {
          trial = std::move(next);
          moved = true;
        }
      }
      if (!knows_onset(trial.candidate) && reach > 20) {  // the best row near, all else held
        const Index first = std::max(margin, trial.candidate.onset - reach);
        const Index last = std::min(problem_.samples() - margin, trial.candidate.onset + reach);
        Effect other = trial.candidate;
        if (first < last) other.onset = problem_.best_onset(trial.fit, first, last);
        if (other.onset != trial.candidate.onset) {
          Trial next = attempt(other, 5);
          if (next.odds > trial.odds + 1e-9) {
            trial = std::move(next);
            moved = true;
          }
        }
      }
      if (!moved) reach /= 2;
    }
  }

  /// How far a valve slips shows in few rows: from coarse starts the fit ends in plain play. So
  /// where one input is best explained by play or sticking, look at all slips near its width.
  void try_valves(std::vector<Trial>& trials) {
    const Effect best = trials[0].candidate;
    const bool play = best.subject.kind == "deadband";
    if (!play && best.subject.cause != Cause::kStiction) return;
    const auto valve = std::find_if(trials.begin(), trials.end(), [&](const Trial& trial) {
      return trial.candidate.subject.cause == Cause::kStiction &&
             trial.candidate.subject.input == best.subject.input;
    });
    if (valve == trials.end()) return;
    const Effect like = valve->candidate;
    const double width = best.value(play ? "width" : "band", 0.0);
    std::vector<std::pair<double, Effect>> scored;
    for (int percent = 80; percent < 165; percent += 5) {
      const double factor = 0.01 * percent;
      for (const double jump : {0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0})
        for (const bool slips_once : {false, true}) {
          report();
          Effect effect = like;
          effect.slips_once = slips_once;
          effect.coordinates[0].value = factor * width;
          effect.coordinates[1].value = jump * factor * width;
          effect.coordinates[0].step = 0.05 * factor * width;
          effect.coordinates[1].step = -0.05 * factor * width;
          scored.emplace_back(screening_->score(effect), std::move(effect));
        }
    }
    std::sort(scored.begin(), scored.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < 6; ++i) trials.push_back(attempt(scored[i].second, 6));
  }

  /// Play and sticking are not smooth in their widths, nor is a square wave in its edges: look
  /// around, ever closer.
  void polish(Trial& trial) {
    constexpr std::array<double, 6> kReach = {16.0, 8.0, 4.0, 2.0, 1.0, 0.5};  // rows
    for (const double reach : kReach)
      for (bool moved = is_square_wave(trial.candidate); moved;) {
        moved = false;
        for (const Effect& other : other_edges(trial.candidate, reach, problem_)) {
          Trial next = attempt(other, 2);
          if (next.odds <= trial.odds + 1e-6) continue;
          trial = std::move(next);
          moved = true;
          break;
        }
      }
    const Cause cause = trial.candidate.subject.cause;
    if (cause != Cause::kStiction && trial.candidate.subject.kind != "deadband") return;
    constexpr std::array<double, 6> kSteps = {0.3, 0.15, 0.075, 0.0375, 0.01875, 0.009375};
    for (const double step : kSteps) {
      const double factor = 1.0 + step;
      for (bool moved = true; moved;) {
        moved = false;
        for (std::size_t i = 0; i < trial.candidate.coordinates.size(); ++i) {
          for (const double by : {factor, 1.0 / factor}) {
            Effect other = trial.candidate;
            Coordinate& c = other.coordinates[i];
            c.value = std::clamp(c.value * by, c.low, c.high);
            Trial next = attempt(other, 2);
            if (next.odds > trial.odds + 1e-6) {
              trial = std::move(next);
              moved = true;
            }
          }
        }
      }
    }
  }

  bool find_one() {
    without_.clear();
    problem_.settle(accepted_, last_.cvs.empty() ? nullptr : &last_);
    std::vector<Trial> trials;
    for (const Effect& effect : shortlist()) trials.push_back(attempt(effect, 6));
    if (trials.empty()) return false;
    const auto better = [](const Trial& a, const Trial& b) { return a.odds > b.odds; };
    std::sort(trials.begin(), trials.end(), better);
    try_valves(trials);
    std::sort(trials.begin(), trials.end(), better);
    for (std::size_t i = 0; i < std::min<std::size_t>(6, trials.size()); ++i) {
      if (trials[i].candidate.onset > 0 && trials[i].odds > trials[0].odds - 60.0)
        place_onset(trials[i]);
      if (trials[i].odds > 0.5 * trials[0].odds) polish(trials[i]);
    }
    std::sort(trials.begin(), trials.end(), better);
    if (trials[0].odds < settings_.decisive) return false;

    // Once more with rows weighed as the best explanation's innovations ask for. A shock in the
    // noise would vanish with a step fitted to it, so a step has to do without that row's help.
    const bool step = trials[0].candidate.subject.kind == "step";
    const Fit weighing = step ? without(touched(trials[0].candidate, problem_)) : trials[0].fit;
    without_.clear();
    problem_.settle(accepted_, &weighing);
    std::vector<Trial> again;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, trials.size()); ++i)
      again.push_back(attempt(trials[i].candidate, 8));
    std::sort(again.begin(), again.end(), better);
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

  /// The misfit is no parabola in the widths of play and sticking or in a level of saturation: a
  /// row slips or does not. So what the curvature says is widened to where the misfit, with all
  /// else fitted, really has risen by as much as a 95 % interval allows.
  void widen_kinked(SearchResult& result) {
    constexpr double kRise = 3.84;  // chi square, 1 degree of freedom
    Index first = 0;
    for (std::size_t e = 0; e < result.fit.effects.size(); ++e) {
      const Effect& effect = result.fit.effects[e];
      const auto count = static_cast<Index>(effect.coordinates.size());
      const bool kinked = effect.subject.cause == Cause::kStiction ||
                          effect.subject.kind == "deadband" ||
                          (effect.subject.cause == Cause::kInputNonlinearity &&
                           effect.subject.kind == "saturation");
      for (Index i = 0; kinked && i < std::min<Index>(2, count); ++i) {
        double& variance = result.fit.covariance(first + i, first + i);
        const double sd = std::max(std::sqrt(variance),
                                   1e-3 * effect.coordinates[static_cast<std::size_t>(i)].prior_sd);
        const double least = cost_at(result.fit, e, i, 0.0);
        double reach = 0.0;
        for (const double side : {-1.0, 1.0})
          for (const double steps : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 11.0, 15.0, 20.0})
            if (cost_at(result.fit, e, i, side * steps * sd) < least + kRise)
              reach = std::max(reach, steps * sd);
        variance = std::max(variance, reach * reach / kRise);
      }
      first += count;
    }
  }

  /// Cost of the CVs that an effect touches with one of its coordinates held `off` from its value.
  double cost_at(const Fit& fit, std::size_t effect, Index coordinate, double off) {
    report();
    std::vector<Effect> effects = fit.effects;
    std::rotate(effects.begin() + static_cast<std::ptrdiff_t>(effect),
                effects.begin() + static_cast<std::ptrdiff_t>(effect) + 1, effects.end());
    Coordinate& held = effects.back().coordinates[static_cast<std::size_t>(coordinate)];
    held.value = std::clamp(held.value + off, held.low, held.high);
    held.prior_mean = held.value;
    held.prior_sd *= 1e-6;
    const std::vector<int> cvs = touched(effects.back(), problem_);
    return problem_.fit(effects, effects.size() - 1, cvs, 3).cost;
  }

  /// A level that is off from the first row on by far more than the noise moves it is no small
  /// error any more, but a sensor's offset or a disturbance as old as the data.
  void name_levels(SearchResult& result) const {
    for (CvFit& fit : result.fit.cvs) {
      // An input that the model left out has an operating point that nobody knows.
      const bool new_input =
          std::any_of(result.named.begin(), result.named.end(), [&](const Named& named) {
            return named.effect.subject.cause == Cause::kUnmodelledInput &&
                   named.effect.subject.cv == fit.cv;
          });
      if (new_input) continue;
      const CvData& data = problem_.data(fit.cv);
      const double level = data.nuisances(0, 0) * fit.beta(0);
      const double noise = std::sqrt(fit.residual.squaredNorm() / std::max(1.0, data.known.sum()));
      const double memory = std::max(0.02, 1.0 - fit.noise.coefficients.sum());
      Fit alone;
      alone.cvs = {fit};
      const double rows = std::max(1.0, independence(alone) * data.rows);
      const double sd = std::sqrt(fit.variance / rows) / memory;
      if (!(std::abs(level) > kOffsetInNoise * noise && std::abs(level) > kOffsetInSd * sd))
        continue;
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
  std::map<std::vector<int>, Fit> without_;
  std::vector<CvFit> nulls_;  // of this round, one per CV; what the screening looks at
  std::optional<Screening> screening_;
  Fit last_;
};

}  // namespace

SearchResult search(Problem& problem, const SearchSettings& settings) {
  return Search(problem, settings).run();
}

}  // namespace mpm
