#pragma once

#include "core/identify/causes/finding.hpp"

namespace mpm {

/// Whether it says that a part of the plant is not as the model has it; what a measured signal or a
/// set-point does accuses none.
[[nodiscard]] bool accuses(const Subject& subject);

/// The probability, 0..1, that what a finding accuses - its channel, its actuator or its sensor -
/// is what is wrong: its own, and that of the rivals that accuse a part of the same. How one
/// channel is wrong may be open where it is not open which one is.
[[nodiscard]] double probability_of_place(const Finding& finding);

/// Whether something else than what a finding accuses is more probable, by its own odds: such an
/// accusation is a guess.
[[nodiscard]] bool is_guess(const Finding& finding);

}  // namespace mpm
