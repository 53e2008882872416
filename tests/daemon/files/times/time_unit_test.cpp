#include "daemon/files/times/time_unit.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace mpm::test {

TEST_CASE("a duration is read in the largest unit of which it has two") {
  struct Read {
    double seconds;
    std::string unit;
    double size;
  };
  for (const Read& read :
       {Read{0.0, "s", 1.0}, Read{119.0, "s", 1.0}, Read{120.0, "min", 60.0},
        Read{7199.0, "min", 60.0}, Read{7200.0, "h", 3600.0}, Read{-172800.0, "days", 86400.0}}) {
    CAPTURE(read.seconds);
    const files::TimeUnit unit = files::time_unit_of(read.seconds);
    CHECK(unit.name == read.unit);
    CHECK(unit.seconds == read.size);
  }
}

}  // namespace mpm::test
