#pragma once

#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/fit/problem.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

/// Which effects carry over to samples that no fit has seen, and what they gain there: fills in
/// the scores, the extended model and the simulations of `diagnosis`, and moves findings that do
/// not hold to `refused`. `model` is the given one in channels with aux inputs, `base` without.
///
/// One effect after the other, weakest first, is left out of the extension. On the CVs that it
/// touches, the free run must be the better for having it, beyond a block-bootstrap interval: else
/// the finding may stand but repairs nothing. Where it is the worse for it, the finding was none.
void measure_gain(const Problem& problem, SearchResult found, const ModelSpec& model,
                  const ModelSpec& base, const Recording& recording, const Recording* validation,
                  const DiagnosisSettings& settings, Diagnosis& diagnosis);

}  // namespace mpm
