#include "daemon/files/output_folder.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

using mpm::files::OutputFolder;
using mpm::test::read_file;
using mpm::test::TemporaryFolder;
using mpm::test::write_file;

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

TEST_CASE("what others laid beside the files of a folder is not written to") {
  TemporaryFolder folder;
  const std::string victim = folder.file("victim");
  write_file(victim, "precious");
  const std::string pid = std::to_string(getpid());
  for (const std::string& foreseen :
       {".report.json." + pid, "report.json." + pid, std::string(".report.json.tmp"),
        std::string("report.json.tmp"), std::string("report.json~")})
    std::filesystem::create_symlink(victim, folder.file(foreseen));
  OutputFolder reports(folder.file("."));
  reports.write("report.json", "{}");
  reports.commit();
  CHECK(read_file(folder.file("report.json")) == "{}");
  CHECK(read_file(victim) == "precious");
}
