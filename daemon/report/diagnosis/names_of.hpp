#pragma once

#include <string>

#include "core/identify/causes/finding.hpp"
#include "core/identify/causes/signal_names.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// Tags and engineering units for the indices of a diagnosis. Inputs beyond the model's own are the
/// aux signals that the extended model takes.
[[nodiscard]] SignalNames names_of(const DiagnosisRun& run);
/// "the other " where what a finding is in the extended model only together with, which it has, is
/// called as it is itself, else nothing.
[[nodiscard]] const char* other_text(const Finding& finding);
/// What that is.
[[nodiscard]] std::string needed_text(const SignalNames& names, const Finding& finding);

}  // namespace mpm::report
