#pragma once

#include <string>

#include "daemon/io/output_folder.hpp"
#include "daemon/report/diagnosis_run.hpp"

/// The files of a diagnosis, whoever asked for it.
namespace mpm::daemon {

/// extended.yaml.
void write_extended(const DiagnosisRun& run, io::OutputFolder& folder);
/// report.json and report.html; returns the former's text.
std::string write_reports(const DiagnosisRun& run, io::OutputFolder& folder);

}  // namespace mpm::daemon
