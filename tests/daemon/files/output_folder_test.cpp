#include "daemon/files/output_folder.hpp"

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

using mpm::files::OutputFolder;
using mpm::test::read_file;
using mpm::test::TemporaryFolder;

TEST_CASE("the files of a folder appear together, and the folder with them") {
  TemporaryFolder folder;
  const std::string inner = folder.file("a/b");
  {
    OutputFolder reports(inner);
    reports.write("report.json", "{}");
    CHECK_FALSE(std::filesystem::exists(inner + "/report.json"));
  }
  CHECK_FALSE(std::filesystem::exists(folder.file("a")));
  OutputFolder reports(inner);
  reports.write("report.json", "{}");
  reports.write("report.html", "<p>");
  reports.commit();
  CHECK(read_file(inner + "/report.json") == "{}");
  CHECK(read_file(inner + "/report.html") == "<p>");
}
