#include "daemon/files/output_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <exception>
#include <string>

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

TEST_CASE("a folder in which nobody may write is refused with the reason") {
  const TemporaryFolder folder;
  REQUIRE(::chmod(folder.file(".").c_str(), 0555) == 0);
  // To root nothing is forbidden.
  const uid_t user = ::getuid(), nobody = 65534;
  if (user == 0) REQUIRE(::setresuid(nobody, nobody, 0) == 0);
  std::string said;
  try {
    const OutputFolder reports(folder.file("reports"));
  } catch (const std::exception& error) {
    said = error.what();
  }
  if (user == 0) REQUIRE(::setresuid(0, 0, 0) == 0);
  REQUIRE(::chmod(folder.file(".").c_str(), 0755) == 0);
  CHECK_THAT(said, Catch::StartsWith(folder.file("reports") +
                                     ": error: cannot be written to: Permission denied"));
}
