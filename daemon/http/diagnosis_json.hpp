#pragma once

#include "daemon/http/kept_reports.hpp"
#include "daemon/http/unit_json.hpp"

namespace mpm::http {

/// What the last diagnosis found, what its report says of it, and where the reports are.
[[nodiscard]] Json diagnosis_json(const UnitStore& store, const KeptReports& reports);

/// A text as one part of a path: what is no letter, digit or one of `-._~` is %XX.
[[nodiscard]] std::string path_part(const std::string& text);

}  // namespace mpm::http
