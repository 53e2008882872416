#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <regex>

#include "daemon/report/page.hpp"
#include "daemon/report/page_data.hpp"
#include "tests/diagnose/sample_run.hpp"

namespace mpm::test {
namespace {

// For looking at: MPM_PAGE_FOLDER=/tmp diagnose_tests '[.page]'
TEST_CASE("write pages to look at", "[.page]") {
  const char* folder = std::getenv("MPM_PAGE_FOLDER");
  REQUIRE(folder != nullptr);
  const auto write = [&](const char* name, const daemon::DiagnosisRun& run) {
    std::ofstream(std::string(folder) + "/" + name) << daemon::page_html(daemon::page_data(run));
  };
  write("mismatch.html", sample_run());
  write("match.html", matching_run());
  write("long.html", sample_run(60'000));
  daemon::DiagnosisRun bent = sample_run();
  bent.diagnosis.extended.input_blocks[0] = Stiction{0.08, 0.03};
  bent.diagnosis.extended.input_blocks[1] = Polynomial{{0.8, 0.9}};
  bent.diagnosis.extended.output_blocks[2] = Saturation{-2.0, 2.5};
  write("bent.html", bent);
  daemon::DiagnosisRun dates = sample_run();
  dates.recording.start_s = 1767225600.0;
  dates.recording.sample_time_s = 60.0;
  dates.diagnosis.findings[2].onset_s = dates.recording.start_s + 2100.0 * 60.0;
  dates.validation = dates.recording;
  dates.validation_file = "next_week.csv";
  dates.diagnosis.validation_before = dates.diagnosis.before;
  dates.diagnosis.validation_after = dates.diagnosis.after;
  write("dates.html", dates);
}

}  // namespace
}  // namespace mpm::test
