#include "daemon/report/diagnosis/clock_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::test {
namespace {

using namespace mpm::report;

TEST_CASE("moments read as people write them") {
  CHECK(clock_text(812.0) == "812 s");
  CHECK(clock_text(1767225661.5) == "2026-01-01 00:01:01 UTC");
}

}  // namespace
}  // namespace mpm::test
