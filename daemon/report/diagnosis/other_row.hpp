#pragma once

#include <string>

namespace mpm::report {

/// Where no channel would be a mismatch: with the CVs a row earlier, or later.
enum class OtherRow { kNone, kEarlier, kLater };

/// "a row earlier", as in JSON; empty for none.
[[nodiscard]] std::string other_row_name(OtherRow row);
/// What it means and what to do, without a full stop; empty for none.
[[nodiscard]] std::string other_row_text(OtherRow row);

}  // namespace mpm::report
