#pragma once

#include <vector>

#include "tests/hidden/score.hpp"

namespace mpm::hidden {

/// Scores all cases on so many threads, in the order of the requests. Shows how far it is on a
/// terminal.
[[nodiscard]] std::vector<CaseScore> score_all(const std::vector<CaseRequest>& requests, int jobs);

}  // namespace mpm::hidden
