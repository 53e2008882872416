#pragma once

#include "core/identification/identification_data.hpp"

namespace mpm {

/// Smallest p-value, times the number of inputs, of an input not depending on the CVs' past beside
/// that of all inputs (Granger 1969): small where a controller moves it. 1 where nothing can be
/// asked.
[[nodiscard]] double feedback_p_value(const IdentificationData& data);

}  // namespace mpm
