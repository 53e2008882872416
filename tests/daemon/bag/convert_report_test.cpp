#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "daemon/bag/mcap_frame_writer.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "tests/daemon/bag/bench.hpp"

namespace mpm::test {
namespace {

bool told(const bag::ConvertReport& report, const std::string& line) {
  return std::find(report.notices.begin(), report.notices.end(), line) != report.notices.end();
}

TEST_CASE("Of values of the same tag and time the last one counts, and that is told") {
  Bench bench;
  const bool sorted = GENERATE(true, false);
  write_file(bench.folder.file("l.csv"),
             sorted ? "tag,time,value,quality\nu,0,1,good\ny,0,5,good\nu,0,,good\nu,0,3,good\n"
                      "u,60,4,good\n"
                    : "tag,time,value,quality\nu,0,1,good\nu,60,4,good\nu,0,,good\nu,0,3,good\n"
                      "y,0,5,good\n");
  const bag::ConvertReport report = bench.convert("l.csv", "w.csv");
  CHECK(bench.text("w.csv") == "time,u,y\n1970-01-01T00:00:00Z,3,5\n1970-01-01T00:01:00Z,4,\n");
  CHECK(told(report, "2 values replaced by later ones of the same tag and time"));
}

TEST_CASE("Values that no double holds are counted; what is almost zero stays") {
  Bench bench;
  write_file(bench.folder.file("a.csv"),
             "time,u,y\n0,1e999,1e-400\n60,-1e999,-1e-400\n120,inf,4e-320\n180,-Inf,nan\n");
  const bag::ConvertReport report = bench.convert("a.csv", "b.csv");
  CHECK(report.values == 3);
  CHECK(report.missing == 5);
  CHECK(told(report, "4 values taken as missing: they are not finite, or too large for a double"));
  CHECK(bench.text("b.csv") ==
        "time,u,y\n1970-01-01T00:00:00Z,,0\n1970-01-01T00:01:00Z,,-0\n"
        "1970-01-01T00:02:00Z,,4e-320\n1970-01-01T00:03:00Z,,\n");
}

TEST_CASE("Infinite values of a recording are counted, missing ones are not") {
  Bench bench;
  {
    bag::McapFrameWriter writer(bench.folder.file("a.mcap"), bench.unit,
                                {{"u", SignalKind::kMv, 0}});
    Frame frame(bench.unit.counts());
    for (const double value :
         {1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      frame[SignalKind::kMv].values(0) = value;
      frame[SignalKind::kMv].quality[0] = Quality::kGood;
      writer.write(frame);
      ++frame.interval;
      frame.source_time_ns += 60'000'000'000;
    }
    writer.finish();
  }
  const bag::ConvertReport report = bench.convert("a.mcap", "a.csv");
  CHECK(report.missing == 2);
  CHECK(told(report, "1 value taken as missing: not finite"));
}

TEST_CASE("Columns and rows that are no signals are named") {
  Bench bench;
  write_file(bench.folder.file("a.csv"),
             "time,u,u.quality,y.quality,,z\n,%,,,,degC\n0,1,good,bad,7,2\n60,1,good,bad,7,2\n");
  const bag::ConvertReport report = bench.convert("a.csv", "b.csv");
  CHECK(bench.text("b.csv") == "time,u,z\n1970-01-01T00:00:00Z,1,2\n1970-01-01T00:01:00Z,1,2\n");
  CHECK(told(report, "ignored, since the tag that they qualify has no column: y.quality"));
  CHECK(told(report, "1 columns without a name are ignored"));
  CHECK(told(report, "line 2 is taken for a row of units and left out"));
}

TEST_CASE("Tags and topics that the unit does not have are named") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), "time,u,other\n0,1,2\n60,1,2\n");
  CHECK(told(bench.convert("a.csv", "b.csv", bench.with_unit()),
             "left out, since the unit file does not name them: other"));
  {
    bag::McapFrameWriter writer(bench.folder.file("a.mcap"), bench.unit, all_columns());
    Frame frame(bench.unit.counts());
    writer.write(frame);
    writer.finish();
  }
  bag::ConvertOptions options = bench.with_unit();
  options.unit->aux.clear();
  CHECK(told(bench.convert("a.mcap", "c.csv", options),
             "mpm/aux left out: the unit file has no such signals"));

  mcap::Writer writer(bench.folder.file("more.mcap"));
  const auto schema = writer.add_schema("mpm::Sample", "omgidl", "");
  const auto samples = writer.add_channel(schema, "mpm/mv", "cdr");
  const auto alarms = writer.add_channel(schema, "mpm/alarm", "cdr");
  idl::CdrEncoder<mpm_Sample> encoder;
  for (std::string unit : {"small", "other", "other"}) {
    double value = 1.0;
    mpm_Sample sample{};
    sample.unit = unit.data();
    sample.values = {1, 1, &value, false};
    writer.write(samples, 0, 0, encoder.encode(sample));
    writer.write(alarms, 0, 0, encoder.encode(sample));
  }
  writer.finish();
  const bag::ConvertReport report = bench.convert("more.mcap", "more.csv", bench.with_unit());
  CHECK(told(report, "2 samples of other units left out"));
  CHECK(told(report, "3 messages on mpm/alarm left out: no signals in it"));
}

}  // namespace
}  // namespace mpm::test
