#pragma once

#include <vector>

#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/records.hpp"

namespace mpm::live {

/// What `run` says of every channel that may be in alarm, inputs outermost, CVs innermost: the most
/// important finding that touches the channel's CV and, where it is about an input, that input.
[[nodiscard]] std::vector<report::NamedCause> causes_of_channels(const report::DiagnosisRun& run);

}  // namespace mpm::live
