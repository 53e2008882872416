#pragma once

#include "core/identification/identification.hpp"

namespace mpm {

/// Puts in what the readings say of CVs that `whole` (of the same recording, or of what it was
/// condensed to) left out for being read seldom: each by itself, its inputs averaged between two
/// readings. Those that keep to no cycle, or have too few readings, stay left out.
void identify_readings(const Recording& recording, const IdentificationSettings& settings,
                       Identification& whole);

}  // namespace mpm
