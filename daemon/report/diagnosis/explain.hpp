#pragma once

#include <string>
#include <vector>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

/// A diagnosis in plain sentences for operators and engineers.
namespace mpm::report {

/// How a sentence on what was found begins, up to its colon and a space: whether the model is
/// wrong, or the plant disturbed from outside it.
[[nodiscard]] std::string difference_headline(const DiagnosisRun& run);
/// The verdict in one sentence, and what belongs to it in some more; the latter may be empty.
[[nodiscard]] std::string verdict_headline(const DiagnosisRun& run);
[[nodiscard]] std::string verdict_details(const DiagnosisRun& run);
/// Both.
[[nodiscard]] std::string verdict_sentence(const DiagnosisRun& run);
/// What a finding means, with its numbers, tags and units.
[[nodiscard]] std::string explain(const DiagnosisRun& run, const Finding& finding);
/// "dead_time of u1 -> y1: 14.2 worse (odds 1 to 1200)"
[[nodiscard]] std::string rival_text(const DiagnosisRun& run, const Rival& rival);
[[nodiscard]] std::string unexplained_text(const DiagnosisRun& run, const Unexplained& left);
/// Of each CV whose free run is off by more than the CV moves, most of it by a constant, or was
/// before the extended model took that over without a finding.
[[nodiscard]] std::vector<std::string> moved_levels(const DiagnosisRun& run);

[[nodiscard]] const char* name_of(DiagnosisVerdict verdict);

}  // namespace mpm::report
