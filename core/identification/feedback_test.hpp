#pragma once

#include <vector>

#include "core/identification/identification_data.hpp"

namespace mpm {

/// Per input the p-value of its not depending on the CVs' past beside that of all inputs, lags and
/// slow means (Granger 1969): small where a controller moves it. 1 where nothing can be asked. The
/// CVs' past begins `first_lag` rows before: 0 sees every controller, but also a CV that answers
/// within the row; 1 sees all but one without any dynamics.
[[nodiscard]] std::vector<double> feedback_p_values(const IdentificationData& data, int first_lag);

/// The smallest, times the number of inputs.
[[nodiscard]] double feedback_p_value(const IdentificationData& data, int first_lag);

/// Per input whether it is a test signal, that no controller makes: nothing before it foretells it,
/// or it takes few values and the CVs' past does not foretell it (that of a relay's would).
[[nodiscard]] std::vector<bool> test_signals(const IdentificationData& data);

}  // namespace mpm
