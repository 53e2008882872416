#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/fit/problem.hpp"

namespace mpm {

/// Share of the work of a diagnosis that is done when all causes have been looked for.
constexpr double kSearched = 0.9;

struct SearchSettings {
  int max_findings = 9;  ///< jumps of one CV that are found together count as one
  /// 2 ln odds that a cause must have against the model without it, and against being one of many.
  double decisive = 3.0;
  /// Channel errors below these are no findings.
  Tolerances materiality = {0.05, 0.09, 0.45};
  /// Nor is what moves a CV by less than this share of its own s.d.
  double visible = 0.015;
  /// Whether what bends is looked for (Cause::is_curve): not where inputs are means of several
  /// samples, for what is bent there is no mean of what bends them.
  bool curves = true;
  /// Whether what the data show themselves is taken in (Cause::shown_by).
  bool shown = true;
  int threads = 1;  ///< >= 1; nothing of the result depends on it
  /// Whether what may not be named is told of as a suspect.
  bool suspects = true;
  /// Which effects may be named at all; empty = all. Others are only told of as suspects.
  std::function<bool(const Effect&)> may_name = {};
  /// Called about once per fit with the share done, by the thread that searches; may throw to end
  /// the search as soon as the fits at hand are done.
  std::function<bool(double)> progress = {};
};

/// A cause as the search came upon it.
struct Named {
  Effect effect;
  double evidence = 0.0;  ///< 2 ln odds against leaving it out
  double confidence = 0.0;
  std::vector<Rival> rivals;
};

struct SearchResult {
  std::vector<Named> named;  ///< in the order of the effects in `fit`, with their fitted numbers
  Fit fit;                   ///< all of them together, all CVs
  /// What would explain more than all that was named and may not be named; the most probable one.
  std::optional<Named> suspect;
  /// A jump for which only its first row speaks, as for a shock of the noise, so that it was not
  /// named: that of the last round.
  std::optional<Named> doubted;
};

/// Finds what explains the data, one cause after the other: the most probable of all candidates is
/// accepted if the odds are decisive, and everything is fitted anew; at the end, what has become
/// superfluous goes.
[[nodiscard]] SearchResult search(Problem& problem, const SearchSettings& settings);

/// What is left of a result when some of what was named goes (`out`, one per named): the rest is
/// fitted anew, and what only made sense beside it goes too.
[[nodiscard]] SearchResult without(Problem& problem, const SearchResult& found,
                                   const std::vector<bool>& out, const SearchSettings& settings);

}  // namespace mpm
