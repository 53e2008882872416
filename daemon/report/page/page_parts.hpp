#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/report/page/wording.hpp"

/// What a diagnosis's page and an identification's have in common.
namespace mpm::report {

/// "3000 samples, 1 min apart: 3 May 2024 14:20 to 5 May 2024 03:10 (UTC)"; of a long recording
/// also what of it they are.
[[nodiscard]] std::string span_text(const Recording& recording, const Condensing& how,
                                    const Clock& clock);

/// Set-points that never move, and records that are short beside what the model takes to settle.
/// `tags`: of each CV's set-point, empty where it has none.
[[nodiscard]] std::vector<std::string> weak_data(const Recording& recording,
                                                 const std::vector<std::string>& setpoints,
                                                 Eigen::Index settling);

/// [[name, text], ...] of what was run.
[[nodiscard]] nlohmann::ordered_json facts(
    const std::vector<std::pair<std::string, std::string>>& rows);

/// "u1, u2 and u3"
[[nodiscard]] std::string listed(const std::vector<std::string>& words);

}  // namespace mpm::report
