#include "daemon/host/terminal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>

using namespace mpm::host;

TEST_CASE("where no terminal is, $COLUMNS says how wide it would be") {
  const int nothing = open("/dev/null", O_WRONLY);
  REQUIRE(nothing >= 0);
  unsetenv("COLUMNS");
  CHECK(terminal_width(nothing) == 80);
  setenv("COLUMNS", "132", 1);
  CHECK(terminal_width(nothing) == 132);
  setenv("COLUMNS", "wide", 1);
  CHECK(terminal_width(nothing) == 80);
  unsetenv("COLUMNS");
  close(nothing);
}
