#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "core/mismatch/verdict.hpp"

namespace mpm {

/// Why a verdict is undetermined, with the tag of another signal that it names: "bad_data",
/// "collinear with u3", "bad_data with u2". Empty for kNone.
[[nodiscard]] std::string reason_text(Reason reason, std::string_view confounder);
/// The way back; kNone where the reason is not known.
[[nodiscard]] std::pair<Reason, std::string> parse_reason(std::string_view text);

}  // namespace mpm
