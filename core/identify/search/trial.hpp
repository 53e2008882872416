#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/identify/fit/problem.hpp"
#include "core/identify/search/search.hpp"
#include "core/parallel/mutex.hpp"
#include "core/parallel/parallel.hpp"

namespace mpm {

/// A candidate, fitted with the accepted effects that live on its CVs alone.
struct Trial {
  Effect candidate;
  Fit fit;            ///< effects: the frozen ones, the accepted free ones, the candidate last
  double odds = 0.0;  ///< 2 ln, against the same CVs without it
};

/// The most probable first.
[[nodiscard]] inline bool more_probable(const Trial& a, const Trial& b) { return a.odds > b.odds; }

/// Tries candidates beside what is accepted, on settings.threads threads. Between two calls of
/// settle() anything may be asked by several of them at once.
class Trials {
 public:
  /// All must outlive it. `tell` is called before each fit that this thread makes, and may throw to
  /// end it all.
  Trials(Problem& problem, const SearchSettings& settings, const std::vector<Effect>& accepted,
         std::function<void()> tell)
      : problem_(problem),
        settings_(settings),
        accepted_(accepted),
        tell_(std::move(tell)),
        parallel_(settings.threads) {}

  /// What a long loop of its users calls too.
  void tell() const {
    if (parallel_.at_home()) tell_();
  }
  [[nodiscard]] const Parallel& parallel() const { return parallel_; }
  [[nodiscard]] Problem& problem() { return problem_; }

  /// To be called after whatever moves the accepted effects: weighs the problem's rows anew, as
  /// `fit` asks for (Problem::settle).
  void settle(const Fit* fit);

  /// Fits the candidate in at most so many steps. The odds of what nobody would care about are at
  /// most even.
  [[nodiscard]] Trial attempt(const Effect& candidate, int iterations);
  /// 2 ln of the odds for one effect of a fit against the fit without it, on the same CVs; of a
  /// function of time, and of a channel that changes, no more than `most_odds`.
  [[nodiscard]] double odds_of(const Fit& with, std::size_t effect, const Fit& without);
  /// Each of them, in their order.
  [[nodiscard]] std::vector<Trial> attempt_all(const std::vector<Effect>& candidates,
                                               int iterations);

  /// Fits several candidates of one CV together, in at most so many steps; they are its last
  /// effects.
  [[nodiscard]] Fit fit_beside(const std::vector<Effect>& candidates, int iterations);
  /// The accepted effects alone.
  [[nodiscard]] const Fit& without(const std::vector<int>& cvs);

 private:
  /// Accepted effects that touch other CVs too come first and stay; returns how many.
  [[nodiscard]] std::size_t arrange(const std::vector<int>& cvs,
                                    std::vector<Effect>& effects) const;
  /// Odds with the noise model held that the candidate left, so that none can swallow it.
  [[nodiscard]] double settled_odds(const Trial& trial, const std::vector<int>& cvs);
  [[nodiscard]] bool material(const Trial& trial);

  Problem& problem_;
  const SearchSettings& settings_;
  const std::vector<Effect>& accepted_;
  std::function<void()> tell_;
  Parallel parallel_;
  Mutex mutex_;
  std::map<std::vector<int>, Fit> without_ MPM_GUARDED_BY(mutex_);
};

}  // namespace mpm
