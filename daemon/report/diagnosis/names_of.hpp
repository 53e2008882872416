#pragma once

#include "core/identify/causes/signal_names.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::report {

/// Tags and engineering units for the indices of a diagnosis. Inputs beyond the model's own are the
/// aux signals that the extended model takes.
[[nodiscard]] SignalNames names_of(const DiagnosisRun& run);

}  // namespace mpm::report
