#pragma once

#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm::report {

/// Where to look: the rows whose weights add up to most, `length` of them (or as many as a run
/// has), inside one run and without a row of `taken`; none where nothing is left. Weights that are
/// not finite count as 0. Of equals the first.
[[nodiscard]] Run telling_window(const std::vector<double>& weights, const std::vector<Run>& runs,
                                 Eigen::Index length, const std::vector<Run>& taken);

/// The rows around `row`, a quarter of them before it, inside its run.
[[nodiscard]] Run window_around(Eigen::Index row, const std::vector<Run>& runs,
                                Eigen::Index length);

}  // namespace mpm::report
