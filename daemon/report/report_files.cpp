#include "daemon/report/report_files.hpp"

#include "daemon/report/diagnosis/diagnosis_report.hpp"
#include "daemon/report/diagnosis/extended_unit.hpp"
#include "daemon/report/identification/identification_report.hpp"
#include "daemon/report/page/diagnosis_page.hpp"
#include "daemon/report/page/identification_page.hpp"
#include "daemon/report/page/page.hpp"
#include "daemon/report/record_json.hpp"
#include "daemon/report/unit_performance.hpp"

namespace mpm::report {

std::string write_reports(const DiagnosisRun& run, files::OutputFolder& folder) {
  folder.write(kDiagnosisFiles[0], extended_yaml(run));
  nlohmann::ordered_json report = to_json(run);
  if (run.performance) report["performance"] = performance_json(*run.performance);
  std::string json = json_text(report, 2) + "\n";
  folder.write(kDiagnosisFiles[1], json);
  folder.write(kDiagnosisFiles[2], page_html(page_data(run)));
  return json;
}

void write_reports(const IdentificationRun& run, files::OutputFolder& folder) {
  folder.write(kIdentificationFiles[0], json_text(to_json(run), 2) + "\n");
  folder.write(kIdentificationFiles[1], page_html(page_data(run)));
}

}  // namespace mpm::report
