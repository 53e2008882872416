#include "daemon/files/csv/csv_reader.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "daemon/files/csv/csv_rows.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "tests/daemon/files/csv/reading.hpp"
#include "tests/system/process.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

namespace {

/// The same two rows in every layout below.
void check_two_rows(const std::vector<Frame>& frames) {
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].interval == 0);
  CHECK(frames[1].interval == 1);
  CHECK(frames[1].source_time_ns - frames[0].source_time_ns == 1'000'000'000);
  CHECK(mv(frames[0], 0) == 1.5);
  CHECK(mv(frames[0], 1) == -2.0);
  CHECK(frames[0][SignalKind::kCv].values(0) == 3.25);
  CHECK(frames[0][SignalKind::kCv].quality[0] == Quality::kGood);
  CHECK(mv(frames[1], 0) == 4.0);
  CHECK(std::isnan(mv(frames[1], 1)));
  CHECK(frames[1][SignalKind::kMv].quality[1] == Quality::kBad);
  CHECK(frames[1][SignalKind::kCv].values(0) == 6.0);
}

}  // namespace

TEST_CASE("Wide files in all their dialects give the same frames") {
  const std::string text = GENERATE(values<std::string>({
      "time,u1,u2,y1\n0,1.5,-2,3.25\n1,4,,6\n",
      "# a comment\n\n# another\ntime,u1,u2,y1\n0,1.5,-2,3.25\n# within\n1,4,nan,6\n",
      "\xEF\xBB\xBFtime,u1,u2,y1\r\n0,1.5,-2,3.25\r\n1,4,Bad,6\r\n",
      "time;u1;u2;y1\n0;1,5;-2;3,25\n1;4,0;No Data;6\n",
      "time;u1;u2;y1\n0,000;1.5;-2,0;3.25\n1,000;4;I/O Timeout;6\n",
      "time\tu1\tu2\ty1\n0\t1.5\t-2\t3.25\n1\t4\t\t6\n",
      "Timestamp,u1,u2,y1\n2024-05-01T12:00:00Z,1.5,-2,3.25\n2024-05-01T12:00:01Z,4,BAD,6\n",
      "time,u1,u2,y1\nunits,%,%,degC\n0,1.5,-2,3.25\n1,4,,6\n",
      "time,u1,u2,y1\n,%,%,degC\n0,1.5,-2,3.25\n1,4,,6\n",
      "\"time\",\"u1\",\"u2\",\"y1\"\n\"0\",\"1.5\",\"-2\",\"3.25\"\n1,4,\"\",6\n",
      "time , u1 , u2 , y1\n 0 , 1.5 , -2 , 3.25\n 1 , 4 , NaN , 6\n",
      "y1,time,u2,u1\n3.25,0,-2,1.5\n6,1,,4\n",
      "time,u1,u2,y1,\n0,1.5,-2,3.25,\n1,4,,6,\n",
      "t_s,u1,u2,y1\n0,1.5,-2,3.25\n1,4,,6",
      ",u1,u2,,y1,\n2024-05-01T12:00:00Z,1.5,-2,,3.25,\n2024-05-01T12:00:01Z,4,,,6,\n",
      "Date,Time,u1,u2,y1\n5/13/2024,12:00:00Z,1.5,-2,3.25\n5/13/2024,12:00:01Z,4,Manual,6\n",
      "time,u1,u2,y1\n0,+1.5,-2,325e-2\n1,4,#N/A,6\n",
  }));
  CAPTURE(text);
  check_two_rows(frames_of(text));
}

TEST_CASE("Long files in all their dialects give the same frames") {
  const std::string text = GENERATE(values<std::string>({
      "tag,time,value,quality\nu1,0,1.5,good\nu2,0,-2,good\ny1,0,3.25,good\n"
      "u1,1,4,good\nu2,1,,good\ny1,1,6,good\n",
      // sorted by tag
      "tag,time,value,quality\nu1,0,1.5,192\nu1,1,4,192\nu2,0,-2,192\nu2,1,Bad,0\n"
      "y1,0,3.25,192\ny1,1,6,192\n",
      // AVEVA names, other order, a tag nobody knows, no row for what is missing
      "TagName,DateTime,Value,Quality,QualityDetail\n"
      "u1,2024-05-01 12:00:00Z,1.5,192,192\nx,2024-05-01 12:00:00Z,text,192,192\n"
      "u2,2024-05-01 12:00:00Z,-2,192,192\ny1,2024-05-01 12:00:00Z,3.25,192,192\n"
      "u1,2024-05-01 12:00:01Z,4,192,192\ny1,2024-05-01 12:00:01Z,6,192,192\n",
      "value;tag;time\n1,5;u1;0\n-2;u2;0\n3,25;y1;0\n4;u1;1\n6;y1;1\n",
  }));
  CAPTURE(text);
  check_two_rows(frames_of(text));
}

TEST_CASE("Quality columns say what a value is worth") {
  const std::vector<Frame> frames = frames_of(
      "time,u1,u1.quality,u2,u2.Quality,y1,y1.quality\n"
      "0,1,good,2,uncertain,3,bad\n"
      "1,1,192,2,64,3,0\n"
      "2,1,216,2,88,3,24\n"
      "3,1,,2,Good,,good\n"
      "4,1,1073741824,2,2147483648,3,GOOD\n");
  REQUIRE(frames.size() == 5);
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    CHECK(frame[SignalKind::kMv].quality == std::vector{Quality::kGood, Quality::kUncertain});
    CHECK(frame[SignalKind::kCv].quality[0] == Quality::kBad);
    CHECK(frame[SignalKind::kCv].values(0) == 3.0);
  }
  CHECK(frames[3][SignalKind::kMv].quality == std::vector{Quality::kGood, Quality::kGood});
  CHECK(frames[3][SignalKind::kCv].quality[0] == Quality::kBad);  // good, but not there
  CHECK(frames[4][SignalKind::kMv].quality == std::vector{Quality::kUncertain, Quality::kBad});
}

TEST_CASE("Every kind of signal finds its place") {
  const std::vector<Frame> frames = frames_of("time,u1,u2,y1,p1,s1,amb\n0,1,2,3,4,5,6\n");
  REQUIRE(frames.size() == 1);
  CHECK(frames[0][SignalKind::kPrediction].values(0) == 4);
  CHECK(frames[0][SignalKind::kSetpoint].values(0) == 5);
  CHECK(frames[0][SignalKind::kAux].values(0) == 6);
  CHECK(frames[0][SignalKind::kDv].size() == 0);
}

TEST_CASE("What is ignored or simulated is said once") {
  CsvReader csv = reader("time,u1,x,u2,x.quality,y1,z\n0,1,text,2,?,3,\n1,1,,2,,3,\n2,1");
  Frame frame;
  int count = 0;
  while (csv.next(frame)) ++count;
  CHECK(count == 2);
  CHECK(csv.notices() ==
        std::vector<std::string>{"ignored, since the unit file does not name them: x, z",
                                 "not in the file, so the unit file's model simulates instead: p1",
                                 "aux tags that are not in the file: amb",
                                 "line 4 is cut off and ignored"});
  CHECK(reader("time,u1,u2,y1,p1,amb\n0,1,2,3,4,5\n").notices().empty());
}

TEST_CASE("What an input cannot be by its limits is marked in each row") {
  config::UnitConfig config = unit();
  config.mv[1].limits = {0.0, 10.0};
  const std::vector<Frame> frames =
      frames_of("time,u1,u2,y1\n0,-9999,2,3\n1,1,-9999,3\n2,1,11,3\n", config);
  REQUIRE(frames.size() == 3);
  const auto usable = [&frames](std::size_t row, int index) {
    return frames[row][SignalKind::kMv].usable(index);
  };
  CHECK(usable(0, 0));  // it has none
  CHECK(usable(0, 1));
  CHECK_FALSE(usable(1, 1));
  CHECK(usable(2, 1));
}

TEST_CASE("The number of rows that a database adds ends the data") {
  for (const char* count : {"(2 rows)", "(2 rows affected)", "2 rows selected."}) {
    CsvReader csv = reader("time,u1,u2,y1,p1,amb\n0,1,2,3,4,5\n1,1,2,3,4,5\n\n" +
                           std::string(count) + "\n\nCompletion time: 2026-03-28T10:00:00\n");
    Frame frame;
    int rows = 0;
    while (csv.next(frame)) ++rows;
    CHECK(rows == 2);
    CHECK(csv.notices() ==
          std::vector<std::string>{"line 5, " + std::string(count) + ", ends the data"});
  }
  const auto problem = [](const std::string& rest) {
    try {
      CsvReader csv = reader("time,u1,u2,y1,p1,amb\n0,1,2,3,4,5\n" + rest);
      Frame frame;
      while (csv.next(frame)) continue;
    } catch (const config::InputError& error) {
      return error.finding().message;
    }
    return std::string();
  };
  CHECK(problem("(1 row)\n1,1,2,3,4,5\n") ==
        "more rows behind their number: give one table a file");
  CHECK(problem("(some rows)\n1,1,2,3,4,5\n") == "has 1 cell, the header 6");
}

TEST_CASE("Intervals are counted from the first row and survive gaps, repeats and steps back") {
  const std::vector<Frame> frames = frames_of(
      "time,u1,u2,y1\n100,1,2,3\n101.02,1,2,3\n101.99,1,2,3\n107,1,2,3\n107,1,2,3\n"
      "106,1,2,3\n108,1,2,3\n109,1,2,3\n110,1,2,3\n");
  std::vector<std::int64_t> intervals;
  intervals.reserve(frames.size());
  for (const Frame& frame : frames) intervals.push_back(frame.interval);
  CHECK(intervals == std::vector<std::int64_t>{0, 1, 2, 7, 7, 6, 8, 9, 10});
  CHECK(frames[1].source_time_ns == 101'020'000'000);
}

TEST_CASE("A clock that was set back goes on counting after a gap") {
  std::string text = "time,u1,u2,y1\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i < 50 ? 5000 + i : 1400 + i) + "," + std::to_string(i) + ",0,1\n";
  CsvReader csv = reader(text);
  Frame frame;
  std::vector<std::int64_t> intervals;
  while (csv.next(frame)) intervals.push_back(frame.interval);
  REQUIRE(intervals.size() == 100);
  for (int i = 0; i < 100; ++i)
    CHECK(intervals[static_cast<std::size_t>(i)] == (i < 50 ? i : i + 1));
  CHECK(std::find_if(csv.notices().begin(), csv.notices().end(), [](const std::string& notice) {
          return notice.rfind("the clock went back by 3599 s", 0) == 0;
        }) != csv.notices().end());
}

TEST_CASE("A clock that drifts and jitters loses no interval") {
  // 0.1 % fast, stamps off by up to 0.3 s: without following, sample 500 would be half a sample
  // off.
  std::string text = "time,u1,u2,y1\n";
  for (int i = 0; i < 3000; ++i) {
    const double jitter = 0.3 * ((i * 7919) % 1000 / 500.0 - 1.0);
    text += std::to_string(1.001 * i + (i == 0 ? 0.0 : jitter)) + ",1,0,1\n";
  }
  const std::vector<Frame> frames = frames_of(text);
  for (std::size_t i = 0; i < frames.size(); ++i)
    REQUIRE(frames[i].interval == static_cast<std::int64_t>(i));
}

TEST_CASE("Long input streams past the rows read ahead") {
  std::string text = "time,u1,u2,y1\n";
  for (int i = 0; i < 5000; ++i) text += std::to_string(i) + "," + std::to_string(2 * i) + ",0,1\n";
  const std::vector<Frame> frames = frames_of(text);
  REQUIRE(frames.size() == 5000);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    REQUIRE(frames[i].interval == static_cast<std::int64_t>(i));
    REQUIRE(mv(frames[i], 0) == 2.0 * static_cast<double>(i));
  }
  CsvReader csv = reader(text);
  for (int i = 0; i < 5000; ++i) {
    Frame fresh;  // of no size yet
    REQUIRE(csv.next(fresh));
    REQUIRE(mv(fresh, 0) == 2.0 * i);
  }
}

TEST_CASE("Bad input is an error at its place") {
  struct Case {
    std::string text, error;
  };
  const auto [text, error] = GENERATE(values<Case>({
      {"", "d.csv:1:1: error: the file is empty"},
      {"# only a comment\n", "d.csv:1:1: error: the file is empty"},
      {"time,u1,u2,y1\n", "d.csv:1:1: error: no data below the header"},
      {"u1,u2,y1\n1,2,3\n",
       "d.csv:1:1: error: the first column must be `time`, not 'u1'; if "
       "that holds times, say how they are written with --time-format"},
      {"time,u1\r0,1\r1,2\r",
       "d.csv:1:1: error: its lines end with a carriage return alone; save it with line feeds"},
      {"time,u1,u3,y1\n0,1,2,3\n",
       "d.csv:1:1: error: the file does not hold mv 'u2' (did you mean 'u3'?)"},
      {"time,u1,u2,temperature\n0,1,2,3\n",
       "d.csv:1:1: error: the file does not hold cv 'y1'; it holds temperature"},
      {"time,u1\n0,1\n", "d.csv:1:1: error: the file does not hold mv 'u2', cv 'y1'"},
      {"time,u1,u2,y1,u1\n0,1,2,3,4\n",
       "d.csv:1:15: error: a second column 'u1'; the first is at column 6"},
      {"# c\ntime,u1,u2,y1\n0,1,2,3\n1,1,12abc,3\n",
       "d.csv:4:5: error: '12abc' is no number; leave empty what is missing"},
      {"time,u1,u2,y1\n0,1,2,3\n1,1,12.5 bar,3\n",
       "d.csv:3:5: error: '12.5 bar' is no number; export it without its unit"},
      {"time,u1,u2,y1\n0,1,2,3\n1,1,12%,3\n",
       "d.csv:3:5: error: '12%' is no number; export it without its unit"},
      {"time,u1,u2,y1\n0,1,2,3\n1,1,12\u202F500.5,3\n",
       "d.csv:3:5: error: '12 500.5' is no number; export it without thousands separators"},
      {"time,u1,u2,y1\n0,1,2,3\n1,1,2.3.4,3\n",
       "d.csv:3:5: error: '2.3.4' is no number; leave empty what is missing"},
      {"time,u1,u2,y1\n0,1,2,3\nnoon,1,2,3\n",
       "d.csv:3:1: error: 'noon' is no time: give seconds or ISO 8601 such as "
       "2024-05-01T12:00:00Z, or say how it is written with --time-format"},
      {"time,u1,u2,y1\n2024-05-01T12:00:00,1,2,3\n",
       "d.csv:2:1: error: '2024-05-01T12:00:00' is a local time: add its zone, Z or +hh:mm, or "
       "name it with --time-zone, such as Europe/Berlin or UTC"},
      {"time,u1,u2,y1\n,1,2,3\n",
       "d.csv:2:1: error: '' is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z, "
       "or say how it is written with --time-format"},
      {"time,u1,u2,y1\n0,1,2\n1,1,2,3\n", "d.csv:2:5: error: has 3 cells, the header 4"},
      {"time,u1,u2,y1\n0,1,2,3,4\n", "d.csv:2:9: error: has 5 cells, the header 4"},
      {"time,u1,u2,y1,y1.quality\n0,1,2,3,fine\n",
       "d.csv:2:9: error: 'fine' is no quality: good, uncertain, bad or an OPC code"},
      {"time,u1,u2,y1\n0,\"1,2,3\n", "d.csv:2:3: error: a quote is not closed"},
      {"time,u1,u2,y1\n0,\"1\"x,2,3\n", "d.csv:2:6: error: text after a closing quote"},
      {"time,u1,u2,y1\n0,1,2,3\n60,1,2,3\n120,1,2,3\n",
       "d.csv:1:1: error: the rows are 60 s apart (median), the unit's sample_time is 1 s"},
      {"time,u1,u2,y1\n2,1,2,3\n1,1,2,3\n0,1,2,3\n",
       "d.csv:1:1: error: the rows go back in time: export or sort them with the oldest first"},
      {"time;u1;u2;y1\n0;1.234,5;2;3\n",
       "d.csv:2:3: error: '1.234,5' is no number; export it with a decimal point and without "
       "thousands separators"},
      {"time;u1;u2;y1\n0;980;2,5;3\n1;1.050;2,5;3\n",
       "d.csv:3:3: error: '1.050': the file has decimal commas, and a number such as 1.050, which "
       "may be 1050 or 1.05; export it without thousands separators"},
      {"time;u1;u2;y1\n0;1.050;2;3\n1;980;2,5;3\n",
       "d.csv:3:7: error: '2,5': the file has decimal commas, and a number such as 1.050, which "
       "may be 1050 or 1.05; export it without thousands separators"},
      {"\xFF\xFEt\n", "d.csv:1:1: error: is UTF-16 text; save it as UTF-8"},
      {std::string("time,u1,u2,y1\n0,1,\0,3\n", 22),
       "d.csv:2:1: error: is no text file: it holds a zero byte"},
      {"tag,time,value\nu1,0,1\ny1,0,2\n", "d.csv:1:1: error: the file does not hold mv 'u2'"},
      {"tag,time,value\nu1,0,1\nu2,0,1\ny1,0,7x\n",
       "d.csv:4:6: error: '7x' is no number; leave empty what is missing"},
      {"tag,time,value\nu1,0,1\nu2,9?,1\n",
       "d.csv:3:4: error: '9?' is no time: give seconds or ISO 8601 such as 2024-05-01T12:00:00Z, "
       "or say how it is written with --time-format"},
  }));
  CAPTURE(text);
  CHECK(error_of(text) == error);
}

TEST_CASE("Without a model the prediction is needed") {
  CHECK(error_of("time,u1,u2,y1\n0,1,2,3\n", unit(1.0, false)) ==
        "d.csv:1:1: error: the file does not hold prediction 'p1'");
}

TEST_CASE("Rows may be a tenth off the sample time") {
  CHECK(error_of("time,u1,u2,y1\n0,1,2,3\n1.09,1,2,3\n") == "no error");
  CHECK(error_of("time,u1,u2,y1\n0,1,2,3\n1.11,1,2,3\n") != "no error");
  CHECK(frames_of("time,u1,u2,y1\n0,1,2,3\n0.08,1,2,3\n", unit(0.08)).size() == 2);
}

TEST_CASE("A file that is not there is an error") {
  CHECK_THROWS_WITH(CsvReader("/nowhere/d.csv", unit()), "/nowhere/d.csv: error: no such file");
  CHECK_THROWS_WITH(CsvReader("/tmp", unit()), "/tmp: error: is a folder, not a file");
}

TEST_CASE("A file that cannot be read on is an error, not the end of it") {
  // A regular file whose first byte is no memory of this process.
  CHECK_THROWS_WITH(CsvReader("/proc/self/mem", unit()),
                    "/proc/self/mem:1:1: error: cannot be read: Input/output error");
}

TEST_CASE("A pipe is no data file, and is not waited for") {
  const mpm::test::TemporaryFolder folder;
  const std::string pipe = folder.file("pipe.csv");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(CsvReader(pipe, unit()), pipe + ": error: is no regular file");
  CHECK_THROWS_WITH(CsvRows(pipe, {}), pipe + ": error: is no regular file");
  CHECK_FALSE(mcap::is_recording(pipe));
}

TEST_CASE("A file in ISO 8859-1 is read, and told") {
  const auto config = config::load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: [\"S\u00e4ure\", u2], cv: [y1]}\n"
      "model: {channels: [{cv: y1, mv: u2, gain: 1}]}\n",
      "u.yaml");
  REQUIRE(config.ok());
  for (const char* header : {"time,S\xe4ure,u2,y1", "time,S\u00e4ure,u2,y1"}) {
    CsvReader csv = reader(std::string(header) + "\n0,1.5,-2,3.25\n1,4,,6\n", config.config);
    Frame frame;
    std::vector<Frame> frames;
    while (csv.next(frame)) frames.push_back(frame);
    check_two_rows(frames);
    const std::vector<std::string> notices = csv.notices();
    const bool told = std::find(notices.begin(), notices.end(),
                                "is no UTF-8; it is read as ISO 8859-1") != notices.end();
    CHECK(told == (std::string(header).find('\xe4') != std::string::npos));
  }
}

TEST_CASE("What a wrong cell holds is told in one short line") {
  const std::string cell = "1\x1b[2J" + std::string(100'000, 'x');
  const std::string error = error_of("time,u1,u2,y1\n0,1," + cell + ",3\n");
  CHECK(error.rfind("d.csv:2:5: error: '1\\x1b[2Jxxx", 0) == 0);
  CHECK(error.size() < 300);
  CHECK(error_of("time,u1,u2,y1," + cell + "\n0,1,2x,3,4\n") ==
        "d.csv:2:5: error: '2x' is no number; leave empty what is missing");
}
