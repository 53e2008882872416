#include "daemon/files/csv/format.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "config/finding.hpp"

using namespace mpm;
using namespace mpm::files;

namespace {

struct Found {
  CsvFormat format;
  std::vector<std::string> notices;
  int line = 0;
};

Found found(const std::string& text) {
  LineReader lines(std::make_unique<std::istringstream>(text), "d.csv");
  Found result;
  std::vector<Cell> header;
  result.format = find_format(lines, {}, 60.0, nullptr, header, result.notices);
  result.line = lines.number();
  return result;
}

}  // namespace

TEST_CASE("The header is found below what stands above it") {
  const Found result = found("sep=;\nReport;\nZeit;a\n01.02.2026 00:00;1\n");
  CHECK(result.line == 3);
  CHECK(result.format.delimiter == ';');
  CHECK(result.notices.size() == 1);
}

TEST_CASE("Names may stand above the line that names the time") {
  const Found result = found(",a,b\nTimestamp,m3/h,degC\n2026-02-01 00:00,1,2\n");
  CHECK(result.line == 1);
  CHECK(result.format.layout.values == std::vector<std::size_t>{1, 2});
  CHECK(found(",,\nTimestamp,a,b\n2026-02-01 00:00,1,2\n").line == 2);
}

TEST_CASE("A first column of dates is the time, whatever it is called") {
  CHECK(found("Horodatage,a\n2026-02-01 00:00,1\n").format.layout.time.time == 0);
  CHECK_THROWS_WITH(found("Horodatage,a\n17,1\n"),
                    "d.csv:1:1: error: the first column must be `time`, not 'Horodatage'; if that "
                    "holds times, say how they are written with --time-format");
}

TEST_CASE("The codes of all rows tell what zero means") {
  const std::string header = "tag,time,value,quality\n";
  CHECK(found(header + "a,0,1,0\na,60,1,16\n").format.zero_is_good);
  CHECK_FALSE(found(header + "a,0,1,0\na,60,1,192\n").format.zero_is_good);
  CHECK_FALSE(found(header + "a,0,1,0\na,60,1,24\n").format.zero_is_good);
  CHECK_FALSE(found(header + "a,0,1,good\n").format.zero_is_good);
  std::string late = header;  // further down than what is read of any file
  for (int i = 0; i < 1000; ++i) late += "a," + std::to_string(60 * i) + ",1,0\n";
  CHECK(found(late).format.zero_is_good);
  CHECK_FALSE(found(late + "a,60000,1,192\n").format.zero_is_good);
  // The public format of a wide file: OPC codes.
  CHECK_FALSE(found("time,a,a.quality\n0,1,0\n60,1,0\n").format.zero_is_good);
}

TEST_CASE("A column that is called like a quality and holds none is a signal") {
  const Found result = found("time,P,P_Q,P Status\n0,1,12.7,Good\n60,1,12.8,Good\n");
  CHECK(result.format.layout.values == std::vector<std::size_t>{1, 2});
  REQUIRE(result.format.layout.qualities.size() == 1);
  CHECK(result.format.layout.qualities[0].cell == 3);
}

TEST_CASE("A date beside a time of its own is only a remark") {
  const Found pair = found("Date,Time,a\n2026-02-01,14:05,1\n");
  CHECK(pair.format.layout.time.clock == std::size_t{1});
  const Found remark = found("Date,Time,a\nMonday,0,1\nMonday,60,1\n");
  CHECK(remark.format.layout.time.time == 1);
  CHECK_FALSE(remark.format.layout.time.clock);
  const Found fraction = found("Datum;Zeit;a\n26.03.2026;0,5868;1\n");  // not a time on its own
  CHECK(fraction.format.layout.time.clock);
  CHECK_THROWS_WITH(found("Date,Time,a\n46107,0.5868,1\n"), Catch::Contains("a day number"));
  const Found whole = found("Time,Date,a\n2026-02-01T14:05:00Z,Monday,1\n");
  CHECK(whole.format.layout.time.time == 0);
}

// The line above was split at another delimiter: its cells are none of the columns below.
TEST_CASE("Names that stand above are delimited as the line below") {
  const Found result = found("x\ty\t\tz\nunit,m3/h,timestamp\n1,2,2026-02-01 00:00\n");
  CHECK(result.line == 2);
  CHECK(result.format.layout.time.time == 2);
}
