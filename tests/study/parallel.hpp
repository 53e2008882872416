#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/study/run.hpp"

namespace mpm::study {

/// All runs of an experiment, in the order of their seeds, on `threads` threads. What comes out
/// depends on neither their number nor their order. Shows a bar on stderr if that is a terminal.
[[nodiscard]] std::vector<RunRecord> run_all(const Prepared& prepared, int threads,
                                             const std::string& label);

}  // namespace mpm::study
