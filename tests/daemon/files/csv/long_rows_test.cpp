#include "tests/daemon/files/csv/reading.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

TEST_CASE("Few tags of a table that is sampled lack a row: it is missing, not held") {
  std::string text = "tag,time,value\n";
  for (int k = 0; k < 40; ++k) {
    for (const char* tag : {"u1", "u2", "y1"})
      if (tag[0] != 'y' || k % 10 != 3) text += std::string(tag) + "," + std::to_string(k) + ",1\n";
  }
  const std::vector<Frame> frames = frames_of(text);
  REQUIRE(frames.size() == 40);
  CHECK(frames[13][SignalKind::kCv].quality[0] == Quality::kBad);
  CHECK(frames[14][SignalKind::kCv].quality[0] == Quality::kGood);
}

TEST_CASE("Of the columns for each type of value the one that is filled counts") {
  const std::vector<Frame> frames = frames_of(
      "tagpath,intvalue,floatvalue,stringvalue,datevalue,dataintegrity,t_stamp\n"
      "u1,1,,,,192,0\nu2,,-2.5,,,192,0\ny1,,3.25,,,192,0\n"
      "u1,4,,,,192,1\nu2,,,Stopped,,192,1\ny1,,6,,,300,1\n");
  REQUIRE(frames.size() == 2);
  CHECK(mv(frames[0], 0) == 1);
  CHECK(mv(frames[0], 1) == -2.5);
  CHECK(mv(frames[1], 0) == 4);
  CHECK(frames[1][SignalKind::kMv].quality[1] == Quality::kBad);
  CHECK(frames[1][SignalKind::kCv].quality[0] == Quality::kBad);
  CHECK(error_of("tagid,intvalue,floatvalue,dataintegrity,t_stamp\n1,1,,192,0\n2,,1,192,0\n")
            .find("export it with the names that its numbers stand for") != std::string::npos);
}
