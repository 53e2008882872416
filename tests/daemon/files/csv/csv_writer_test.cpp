#include "daemon/files/csv/csv_writer.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <sstream>

#include "config/finding.hpp"

using namespace mpm;
using namespace mpm::files;

TEST_CASE("A time that no reader takes is not written") {
  const bool seconds = GENERATE(false, true);
  CsvOptions options;
  options.seconds = seconds;
  options.quality = {false};
  std::ostringstream out;
  CsvWriter writer(out, "out.csv", {{"u1", SignalKind::kMv, 0}}, options);
  Frame frame(SignalCounts{1, 0, 0, 0, 0});
  frame.source_time_ns = 1'774'530'300'000'000'000;
  CHECK_NOTHROW(writer.write(frame));
  for (const std::int64_t time_ns :
       {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()}) {
    frame.source_time_ns = time_ns;
    CHECK_THROWS_WITH(writer.write(frame), Catch::Contains("which no data file may have"));
  }
}

TEST_CASE("Why a file cannot be written to is told") {
  std::ofstream full("/dev/full");
  CsvWriter writer(full, "out.csv", {{"u1", SignalKind::kMv, 0}}, {});
  CHECK_THROWS_WITH(writer.finish(), "out.csv: cannot be written to: No space left on device");
}
