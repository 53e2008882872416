#pragma once

#include <vector>

#include "core/record/alarm_record.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::live {

/// What `run` says of every channel that may be in alarm, inputs outermost, CVs innermost: the most
/// important finding that touches the channel's CV and, where it is about an input, that input.
[[nodiscard]] std::vector<NamedCause> causes_of_channels(const report::DiagnosisRun& run);

}  // namespace mpm::live
