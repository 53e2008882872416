#pragma once

#include <array>
#include <string>

#include "daemon/files/output_folder.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

inline constexpr std::array kDiagnosisFiles = {"extended.yaml", "report.json", "report.html"};
inline constexpr std::array kIdentificationFiles = {"model.json", "report.html"};

/// The files of a diagnosis, whoever asked for it.
/// Returns the text of report.json. They appear when `folder` is committed.
std::string write_reports(const DiagnosisRun& run, files::OutputFolder& folder);
/// The files of an identification.
void write_reports(const IdentificationRun& run, files::OutputFolder& folder);

}  // namespace mpm::report
