#include "tests/daemon/files/csv/reading.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

TEST_CASE("Columns of times and values in turn: inputs that are set are held, others on the line") {
  const std::string text = GENERATE(values<std::string>({
      "time,u1,time,u2,time,y1\n0,1,0,5,0,10\n3,2,,,4,18\n,,,,6,18\n",
      "u1,,u2,,y1,\nTimestamp,Value,Timestamp,Value,Timestamp,Value\n"
      "2024-05-01T12:00:00Z,1,2024-05-01T12:00:00Z,5,2024-05-01T12:00:00Z,10\n"
      "2024-05-01T12:00:03Z,2,,,2024-05-01T12:00:04Z,18\n,,,,2024-05-01T12:00:06Z,18\n",
      ",u1,,u2,,y1\n"
      "2024-05-01T12:00:00Z,1,2024-05-01T12:00:00Z,5,2024-05-01T12:00:00Z,10\n"
      "2024-05-01T12:00:03Z,2,,,2024-05-01T12:00:04Z,18\n,,,,2024-05-01T12:00:06Z,18\n",
      "u1,,u2,,y1,\n"
      "2024-05-01T12:00:00Z,1,2024-05-01T12:00:00Z,5,2024-05-01T12:00:00Z,10\n"
      "2024-05-01T12:00:03Z,2,,,2024-05-01T12:00:04Z,18\n,,,,2024-05-01T12:00:06Z,18\n",
      "time,u1,Quality,,time,[u2],,time,y1.PV\n0,1,Good,,0,5,,0,10\n3,2,Good,,,,,4,18\n,,,,,,,6,"
      "18\n",
  }));
  CAPTURE(text);
  CsvReader csv = reader(text);
  CHECK(says(csv, "MVs and set-points are held"));
  const std::vector<Frame> frames = frames_of(std::move(csv));
  REQUIRE(frames.size() == 7);
  for (int k = 0; k < 7; ++k) {
    CAPTURE(k);
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    CHECK(mv(frame, 0) == Approx(k < 3 ? 1 : 2));
    CHECK(mv(frame, 1) == Approx(5));
    CHECK(frame[SignalKind::kCv].values(0) == Approx(k < 4 ? 10 + 2 * k : 18));
  }
}

TEST_CASE("No line leads to or from a value that is bad") {
  const std::vector<Frame> frames =
      frames_of("time,u1,time,u2,time,y1\n0,1,0,5,0,10\n,,,,2,Bad\n,,,,4,18\n,,,,6,20\n");
  REQUIRE(frames.size() == 7);
  const auto y = [&](std::size_t k) { return frames[k][SignalKind::kCv].values(0); };
  CHECK(y(1) == 10);
  CHECK(y(2) == 10);  // of half an interval before: good is taken
  CHECK(std::isnan(y(3)));
  CHECK(y(4) == 18);
  CHECK(y(5) == Approx(19));
}

TEST_CASE("Dates of something else beside the time are no times of their own") {
  const std::vector<Frame> frames = frames_of(
      "when,u1,batch begun,u2,y1\n"
      "2024-05-01T12:00:00Z,1,2024-04-30T08:00:00Z,5,10\n"
      "2024-05-01T12:00:01Z,2,2024-04-30T08:00:00Z,6,11\n");
  REQUIRE(frames.size() == 2);
  CHECK(mv(frames[1], 1) == 6);
  CHECK(error_of("Date,Time,u1,Date,Time,u2,y1\n1/13/2024,12:00,1,1/13/2024,12:00,2,3\n")
            .find("a second column 'Date'") != std::string::npos);
}

TEST_CASE("Mistakes in columns of times and values in turn are told at their place") {
  CHECK(error_of("time,u1,time,u2,time,y1\n0,1,0,5,0,10\n1,2,,3,1,2\n") ==
        "d.csv:3:5: error: '' is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z, "
        "or say how it is written with --time-format");
  CHECK(error_of("time,u1,time,u2,time,y1\n0,1,0,5,0,1.2.3\n").substr(0, 12) == "d.csv:2:11: ");
  CHECK(error_of("time,u1,time,u1,time,u2,time,y1\n0,1,0,5,0,1,0,2\n")
            .find("'u1' stands above two pairs of columns") != std::string::npos);
  CHECK(error_of("time,u1,time,u2\n0,1,0,5\n").find("does not hold cv 'y1'") != std::string::npos);
}
