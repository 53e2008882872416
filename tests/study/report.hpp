#pragma once

#include <string>
#include <vector>

#include "tests/study/experiment.hpp"
#include "tests/study/summary.hpp"

namespace mpm::study {

/// A table of the experiments that were run, as Markdown with aligned columns; empty where none of
/// its experiments was.
[[nodiscard]] std::string render(const Table& table, const std::vector<Summary>& summaries);

/// Every number, for scripts.
[[nodiscard]] std::string to_json(const std::vector<Summary>& summaries);

/// `text` with `content` between the lines `<!-- study:begin NAME -->` and
/// `<!-- study:end NAME -->`, instead of what stood there. Throws std::invalid_argument where these
/// are missing.
[[nodiscard]] std::string replace_part(const std::string& text, const std::string& name,
                                       const std::string& content);

/// Whether a shell pattern (* and ?) matches.
[[nodiscard]] bool matches(const std::string& pattern, const std::string& name);

}  // namespace mpm::study
