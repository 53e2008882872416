#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mpm::report {

/// report.html: one page that needs nothing else, with `data` (of page_data()) inside it.
[[nodiscard]] std::string page_html(const nlohmann::ordered_json& data);

}  // namespace mpm::report
