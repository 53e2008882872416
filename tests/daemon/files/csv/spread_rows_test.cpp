#include "daemon/files/csv/spread_rows.hpp"

#include "tests/daemon/files/csv/reading.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

TEST_CASE("Rows whose seconds are cut off are spread over their minute, if all have equally many") {
  const auto text = [](std::vector<int> counts) {
    std::string rows = "time,u1,u2,y1\n";
    int value = 0;
    for (std::size_t m = 0; m < counts.size(); ++m)
      for (int i = 0; i < counts[m]; ++i)
        rows += "2024-05-01T12:0" + std::to_string(m) + "Z," + std::to_string(value++) + ",2,3\n";
    return rows;
  };
  CsvReader csv = reader(text({2, 4, 4, 4, 1}), unit(15.0));
  CHECK(says(csv, "cut off: the 4 rows of each minute are spread evenly over it"));
  const std::vector<Frame> frames = frames_of(std::move(csv));
  REQUIRE(frames.size() == 15);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    CHECK(frames[k].interval == static_cast<std::int64_t>(k));
    CHECK(mv(frames[k], 0) == static_cast<double>(k));
  }
  // 12:00:30
  CHECK(frames[0].source_time_ns % 60'000'000'000 == 30'000'000'000);
  CHECK(error_of(text({4, 4, 3, 4, 4}), unit(15.0)) ==
        "d.csv:1:1: error: several rows have the same minute for their time, and not each minute "
        "equally many: the seconds are cut off, export them");
  CHECK(error_of(text({4, 4, 4, 4, 4}), unit(10.0)).find("the rows are 15 s apart") !=
        std::string::npos);
  // A row twice in a file of a row a minute is no such file.
  CHECK(frames_of(text({1, 1, 2, 1, 1}), unit(60.0)).size() == 6);
}

TEST_CASE("A minute with another number of rows is told, wherever it comes") {
  std::string rows = "time,u1,u2,y1\n";
  for (int m = 0; m < 59; ++m)
    for (int i = 0; i < (m == 57 ? 5 : 6); ++i)
      rows += "2024-05-01T12:" + std::string(m < 10 ? "0" : "") + std::to_string(m) + "Z,1,2,3\n";
  CHECK(error_of(rows, unit(10.0)) ==
        "d.csv:1:1: error: the minute of 2024-05-01T12:57:00Z has 5 rows, those before it 6: its "
        "seconds are cut off, export them");
}
