#include "sim/output/result_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <thread>

#include "config/finding.hpp"
#include "tests/system/process.hpp"

using mpm::sim::ResultFile;
using mpm::test::read_file;
using mpm::test::TemporaryFolder;
using mpm::test::write_file;

TEST_CASE("a run's file has its name when it is whole, and an older one stays until then") {
  TemporaryFolder folder;
  const std::string path = folder.file("run.csv");
  write_file(path, "old");
  {
    ResultFile broken_off(path);
    broken_off.stream() << "half" << std::flush;
    CHECK(read_file(path) == "old");
  }
  CHECK(read_file(path) == "old");
  ResultFile whole(path);
  whole.stream() << "new";
  whole.commit();
  CHECK(read_file(path) == "new");
}

TEST_CASE("a run is not written through a link to a file") {
  TemporaryFolder folder;
  const std::string victim = folder.file("victim"), link = folder.file("run.csv");
  write_file(victim, "precious");
  std::filesystem::create_symlink(victim, link);
  CHECK_THROWS_AS(ResultFile(link), mpm::config::InputError);
  std::filesystem::create_symlink("nowhere", folder.file("broken"));
  CHECK_THROWS_AS(ResultFile(folder.file("broken")), mpm::config::InputError);
  CHECK(read_file(victim) == "precious");
}

TEST_CASE("a run goes into pipes and devices as they are") {
  TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string read;
  std::thread reader([&] { read = read_file(pipe); });
  {
    ResultFile file(pipe);
    file.stream() << "rows";
    file.commit();
  }
  reader.join();
  CHECK(read == "rows");
  CHECK(std::filesystem::is_fifo(pipe));
  ResultFile nothing("/dev/null");
  nothing.stream() << "rows";
  CHECK_NOTHROW(nothing.commit());
  ResultFile full("/dev/full");
  full.stream() << "rows";
  CHECK_THROWS_WITH(full.commit(), "/dev/full: cannot be written to: No space left on device");
}
