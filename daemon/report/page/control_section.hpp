#pragma once

#include <nlohmann/json.hpp>

#include "core/record/performance_record.hpp"

namespace mpm::report {

/// How well a unit is controlled, for the page: {text, cvs: {columns, rows}, mvs: {columns, rows},
/// note}, all of texts.
[[nodiscard]] nlohmann::ordered_json control_section(const PerformanceRecord& performance,
                                                     double sample_time_s);

}  // namespace mpm::report
