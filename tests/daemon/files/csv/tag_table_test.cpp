#include "daemon/files/csv/tag_table.hpp"

#include "tests/daemon/files/csv/reading.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

TEST_CASE("Decorated names are read as the tags that they can only be, and that is said") {
  const std::string text = GENERATE(values<std::string>({
      "time,[u1],\\\\SRV\\u2,y1 [degC]\n0,1.5,-2,3.25\n1,4,,6\n",
      "time,[default]Heater/u1,Heater/u2 (PV),y1.PV\n0,1.5,-2,3.25\n1,4,,6\n",
      "time,U1,u2,Y1\n0,1.5,-2,3.25\n1,4,,6\n",
      "time,u1.Value,u1.Quality,u2.Value,u2.Quality,y1.Value,y1.Quality\n"
      "0,1.5,192,-2,192,3.25,192\n1,4,192,7,0,6,192\n",
      "tag,time,value\nP/u1,0,1.5\nP/u2,0,-2\nP/y1,0,3.25\nP/u1,1,4\nP/y1,1,6\n",
      // What has the tag's own name is the tag.
      "time,u1,u1 [%],u2,y1,old/y1\n0,1.5,9,-2,3.25,9\n1,4,9,,6,9\n",
  }));
  CAPTURE(text);
  const std::vector<Frame> frames = frames_of(text);
  REQUIRE(frames.size() == 2);
  CHECK(mv(frames[0], 0) == 1.5);
  CHECK(mv(frames[0], 1) == -2.0);
  CHECK(frames[1][SignalKind::kMv].quality[1] == Quality::kBad);
  CHECK(frames[1][SignalKind::kCv].values(0) == 6.0);
  CHECK(frames[1][SignalKind::kCv].quality[0] == Quality::kGood);
}

TEST_CASE("Names read as tags are told; two that may be one tag are an error") {
  CsvReader csv = reader("time,[u1],u2,x/y1\n0,1,2,3\n1,1,2,3\n");
  CHECK(csv.notices().front() ==
        "columns read as tags of the unit file: '[u1]' as u1, 'x/y1' as y1");
  CHECK(error_of("time,u1 [%],u1.PV,u2,y1\n0,1,2,3,4\n") ==
        "d.csv:1:1: error: both 'u1 [%]' and 'u1.PV' may be 'u1': give the one that is meant this "
        "name");
  CHECK(error_of("tag,time,value\nA/u1,0,1\nB/u1,0,1\nu2,0,1\ny1,0,1\n") ==
        "d.csv:1:1: error: both 'A/u1' and 'B/u1' may be 'u1': give the one that is meant this "
        "name");
  CHECK(error_of("time,[u1],[u1],u2,y1\n0,1,2,3,4\n").find("a second column '[u1]'") !=
        std::string::npos);
  CHECK(error_of("time,u1,u2,\\\\SRV\\yy1.PV\n0,1,2,3\n")
            .find("cv 'y1' (did you mean '\\\\SRV\\yy1.PV'?)") != std::string::npos);
}
