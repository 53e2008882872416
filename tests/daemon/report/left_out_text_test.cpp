#include "daemon/report/left_out_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("what was left out is told, values with their tags") {
  config::UnitConfig unit;
  unit.mv.resize(1);
  unit.mv[0].tag = "u";
  unit.dv.resize(1);
  unit.dv[0].tag = "d";
  unit.cv.resize(1);
  unit.cv[0].tag = "y";
  files::RecordingFile file;
  file.jumps = {{0, 0}, {0}};
  CHECK(left_out_texts(unit, file).empty());
  file.jumps = {{0, 2}, {1}};
  file.lost = 300;
  file.scraps = 1;
  CHECK(left_out_texts(unit, file) ==
        std::vector<std::string>{
            "300 rows left out, for an input was missing for more than 20 intervals; a new run "
            "begins after",
            "1 row left out, of runs too short to tell anything",
            "3 values left out, far beyond all that the signal is otherwise, of d "
            "(2), y (1)"});
}

}  // namespace mpm::report
