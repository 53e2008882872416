#pragma once

#include <string>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// The unit with the extended model: aux signals that the model now takes are DVs, in the order of
/// the model's inputs.
[[nodiscard]] config::UnitConfig extended_unit(const config::UnitConfig& unit,
                                               const Diagnosis& diagnosis);

/// The unit with the extended model as far as it uses the unit's own inputs: for a controller that
/// does not have the new ones. As YAML.
[[nodiscard]] std::string own_inputs_yaml(const config::UnitConfig& unit,
                                          const Diagnosis& diagnosis);

/// The extended unit as a unit file that begins with what was changed and why. Throws
/// std::logic_error where that would not load back.
[[nodiscard]] std::string extended_yaml(const DiagnosisRun& run);

}  // namespace mpm::report
