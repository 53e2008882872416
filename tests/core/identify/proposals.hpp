#pragma once

#include <string>
#include <vector>

#include "core/identify/causes/cause.hpp"

/// What the causes propose and say of a plant for which each of them has something to propose. A
/// test gets the quantities from here that are a cause's own.
namespace mpm::test {

/// Two inputs, one of which acts on both CVs, two tanks, a spring, and a signal that the model
/// leaves out.
[[nodiscard]] Problem& open_problem();

[[nodiscard]] std::vector<Effect> proposals_of(const Cause& cause);

/// The same as findings, with the start values in them; and what the cause finds in innovations
/// that become three times as large half way.
[[nodiscard]] std::vector<Finding> findings_of(const Cause& cause);

/// The one of that name, of the numbers that a cause fits or says.
[[nodiscard]] const Quantity& quantity_of(const Cause& cause, const std::string& name);

}  // namespace mpm::test
