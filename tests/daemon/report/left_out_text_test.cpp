#include "daemon/report/left_out_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("values that were left out are told with their tags") {
  config::UnitConfig unit;
  unit.mv.resize(1);
  unit.mv[0].tag = "u";
  unit.dv.resize(1);
  unit.dv[0].tag = "d";
  unit.cv.resize(1);
  unit.cv[0].tag = "y";
  CHECK(left_out_text(unit, {{0, 0}, {0}}).empty());
  CHECK(left_out_text(unit, {{0, 2}, {1}}) ==
        "3 values left out, far beyond all that the signal had been and back at once, of d (2), y "
        "(1)");
}

}  // namespace mpm::report
