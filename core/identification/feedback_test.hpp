#pragma once

#include "core/identification/identification_data.hpp"

namespace mpm {

/// Smallest p-value, times the number of inputs, of an input not depending on the CVs' past beside
/// that of all inputs (Granger 1969): small where a controller moves it. 1 where nothing can be
/// asked. The CVs' past begins `first_lag` rows before: 0 sees every controller, but also a CV that
/// answers within the row; 1 sees all but one without any dynamics.
[[nodiscard]] double feedback_p_value(const IdentificationData& data, int first_lag);

}  // namespace mpm
