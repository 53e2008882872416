#pragma once

#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/hidden/hidden_case.hpp"

namespace mpm::hidden {

/// How far a finding says a true effect.
enum class Match { kOther, kCause, kPlace };
[[nodiscard]] Match match(const HiddenCase& hidden, const TrueEffect& truth,
                          const Subject& subject);

/// The findings that say a true effect: one, the parts of `dynamics`, or none. One at the right
/// place goes before the others.
struct Answer {
  Match match = Match::kOther;
  std::vector<const Finding*> findings;
};
[[nodiscard]] Answer answer_to(const HiddenCase& hidden, const TrueEffect& truth,
                               const std::vector<Finding>& findings);

}  // namespace mpm::hidden
