#include "daemon/http/kept_reports.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/system/process.hpp"

namespace mpm::http {
namespace {

TEST_CASE("reports are listed and read, and nothing beside them") {
  const test::TemporaryFolder folder;
  for (const char* name : {"20240501T120000Z", "20240502T120000.250Z", "notes"}) {
    std::filesystem::create_directories(folder.file(std::string("unit%201/") + name));
    test::write_file(folder.file(std::string("unit%201/") + name + "/report.html"), "page");
  }
  test::write_file(folder.file("secret"), "x");
  const KeptReports reports(folder.file(""));
  CHECK(reports.names("unit 1") ==
        std::vector<std::string>{"20240502T120000.250Z", "20240501T120000Z"});
  CHECK(reports.names("other").empty());
  CHECK(reports.read("unit 1", "20240501T120000Z", "report.html") == "page");
  CHECK_FALSE(reports.read("unit 1", "20240501T120000Z", "report.json"));
  CHECK_FALSE(reports.read("unit 1", "20240501T120000Z", "../../secret"));
  CHECK_FALSE(reports.read("unit 1", "notes", "report.html"));
  CHECK_FALSE(reports.read("unit 1", "..", "secret"));
  CHECK_FALSE(reports.read("../..", "20240501T120000Z", "report.html"));
}

TEST_CASE("without a folder there are none") {
  CHECK(KeptReports("").names("unit").empty());
  CHECK_FALSE(KeptReports("").read("unit", "20240501T120000Z", "report.html"));
}

}  // namespace
}  // namespace mpm::http
