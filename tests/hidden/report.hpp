#pragma once

#include <string>
#include <vector>

#include "tests/hidden/score.hpp"

namespace mpm::hidden {

/// Markdown with aligned columns: the first finding's cause against what was hidden; how right each
/// class is; how often parameters lie within their intervals.
[[nodiscard]] std::string confusion_table(const std::vector<CaseScore>& scores);
[[nodiscard]] std::string class_table(const std::vector<CaseScore>& scores);
[[nodiscard]] std::string parameter_table(const std::vector<CaseScore>& scores);

/// One line: class, plant, seed, truth, answer.
[[nodiscard]] std::string line_of(const CaseScore& score);

}  // namespace mpm::hidden
