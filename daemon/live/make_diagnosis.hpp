#pragma once

#include <optional>

#include "daemon/live/diagnosis_worker.hpp"
#include "daemon/live/report_store.hpp"

namespace mpm::live {

/// What a DiagnosisWorker does in mpmd: diagnoses the samples of `job`, keeps the report.
[[nodiscard]] std::optional<DiagnosisOutcome> make_diagnosis(const DiagnosisJob& job,
                                                             const ReportStore& store,
                                                             const DiagnosisWorker::GoOn& go_on);

}  // namespace mpm::live
