#include "daemon/live/report_store.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "daemon/live/named_cause.hpp"
#include "tests/daemon/report/sample_run.hpp"
#include "tests/system/process.hpp"

namespace mpm::live::report_store_test {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kHour = 3'600'000'000'000;

std::set<std::string> names(const fs::path& folder) {
  std::set<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    found.insert(entry.path().filename().string());
  return found;
}

}  // namespace

TEST_CASE("the store writes all files of a diagnosis and keeps the last written ones") {
  const test::TemporaryFolder folder;
  const ReportStore store(folder.file("state"), 2);
  const report::DiagnosisRun run = test::sample_run(600);
  const fs::path unit = folder.file("state/shell");
  CHECK(store.write(run, 5 * kHour) == (unit / "19700101T050000Z").string());
  CHECK(names(unit / "19700101T050000Z") ==
        std::set<std::string>{"report.json", "report.html", "extended.yaml"});
  fs::create_directory(unit / "notes");
  CHECK(store.write(run, 5 * kHour) == (unit / "19700101T050000Z").string());
  (void)store.write(run, 3 * kHour);
  (void)store.write(run, 1 * kHour);
  CHECK(names(unit) == std::set<std::string>{"19700101T030000Z", "19700101T010000Z", "notes"});
}

TEST_CASE("nothing is written where nothing is to be kept; what cannot be written is an error") {
  const test::TemporaryFolder folder;
  const report::DiagnosisRun run = test::sample_run(600);
  CHECK(ReportStore("").write(run, 0).empty());
  test::write_file(folder.file("file"), "");
  CHECK_THROWS_AS(ReportStore(folder.file("file")).write(run, 0), std::exception);
}

TEST_CASE("an alarm gets the finding that touches its channel") {
  const report::DiagnosisRun run = test::sample_run(600);
  const std::vector<NamedCause> causes = causes_of_channels(run);
  REQUIRE(causes.size() == 9);
  const NamedCause& gain = causes[2 * 3 + 2];  // u3 -> y3
  CHECK(gain.cause == "gain");
  REQUIRE_FALSE(gain.parameters.empty());
  CHECK(gain.parameters[0].name == "gain_ratio");
  CHECK(gain.parameters[0].value == Approx(1.4).margin(0.1));
  CHECK(gain.text.find("y3 answers u3") == 0);
  CHECK(gain.confidence > 0.5);
  CHECK_FALSE(causes[0 * 3 + 2].cause);  // u1 -> y3
  CHECK(causes[0 * 3 + 2].text.find("Not this channel, but another of its CV: y3") == 0);
  CHECK(causes[0 * 3 + 0].cause == "unmodelled_input");
  CHECK(causes[1 * 3 + 1].cause == "output_disturbance");

  for (const NamedCause& cause : causes_of_channels(test::matching_run())) {
    CHECK_FALSE(cause.cause);
    CHECK(cause.text.find("matches the plant") != std::string::npos);
  }
}

}  // namespace mpm::live::report_store_test
