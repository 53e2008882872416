#pragma once

#include <string>

#include "daemon/files/output_folder.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// The files of a diagnosis, whoever asked for it: extended.yaml, report.json and report.html.
/// Returns the text of report.json. They appear when `folder` is committed.
std::string write_reports(const DiagnosisRun& run, files::OutputFolder& folder);
/// The files of an identification: model.json and report.html.
void write_reports(const IdentificationRun& run, files::OutputFolder& folder);

}  // namespace mpm::report
