#include <catch2/catch.hpp>
#include <map>

#include "daemon/bag/mcap_frame_writer.hpp"
#include "daemon/bag/mcap_frames.hpp"
#include "daemon/mcap/read/ordered_reader.hpp"
#include "tests/daemon/bag/bench.hpp"
#include "tests/daemon/mcap/files.hpp"

namespace mpm::test {
namespace {

/// Values of every signal that the row has, two of them not good; no row `skipped`.
void write_recording(const Bench& bench, const std::string& name,
                     const std::vector<files::Column>& columns, int skipped = -1) {
  bag::McapFrameWriter writer(bench.folder.file(name), bench.unit, columns);
  for (int k = 0; k < 40; ++k) {
    if (k == skipped) continue;
    Frame frame(bench.unit.counts());
    for (SignalBlock& block : frame.blocks) {
      block.values.setConstant(std::numeric_limits<double>::quiet_NaN());
      std::fill(block.quality.begin(), block.quality.end(), Quality::kBad);
    }
    frame.interval = k;
    frame.source_time_ns = k * 60'000'000'000;
    for (const files::Column& column : columns) {
      frame[column.kind].values(column.index) = 0.1 * k + column.index;
      frame[column.kind].quality[static_cast<std::size_t>(column.index)] =
          k == 7 ? Quality::kUncertain : Quality::kGood;
    }
    writer.write(frame);
  }
  writer.finish();
}

TEST_CASE("A recording of some topics or signals only goes to CSV and back, bit by bit") {
  Bench bench;
  const std::vector<files::Column> all = all_columns();
  const auto columns = GENERATE_COPY(values<std::vector<files::Column>>({
      {all[0]},                 // the MV
      {all[1], all[6]},         // a DV, an aux signal
      {all[0], all[3]},         // of two CVs the second
      {all[4]},                 // predictions
      {all[5], all[2], all[0]}  // no DV
  }));
  write_recording(bench, "a.mcap", columns);
  static_cast<void>(bench.convert("a.mcap", "a.csv"));
  const bag::ConvertReport report = bench.convert("a.csv", "b.mcap", bench.with_unit());
  CHECK(report.signals == columns.size());
  CHECK(report.rows == 40);
  CHECK(report.missing == 0);
  REQUIRE(report.notices.size() == 1);
  CHECK(report.notices[0].find("signals of the unit that are not in the file: ") == 0);
  CHECK(bench.text("b.mcap") == bench.text("a.mcap"));
}

TEST_CASE("A CSV without one signal of the unit becomes no recording") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), "time,a,b\n0,1,2\n60,1,2\n");
  CHECK(bench.error("a.csv", "a.mcap", bench.with_unit()) ==
        bench.folder.file("a.csv") +
            ":1:1: error: the file holds no signal of unit 'small'; it holds a, b");
}

TEST_CASE("What control intervals lack is told by its topic") {
  Bench bench;
  std::vector<files::Column> cvs, others;
  for (const files::Column& column : all_columns())
    (column.kind == SignalKind::kCv ? cvs : others).push_back(column);
  write_recording(bench, "cvs.mcap", cvs, 20);
  write_recording(bench, "others.mcap", others);
  bag::McapFrames frames({bench.folder.file("cvs.mcap"), bench.folder.file("others.mcap")},
                         bench.unit, files::Purpose::kJudge);
  int rows = 0;
  for (Frame frame; frames.next(frame);) ++rows;
  CHECK(rows == 40);
  CHECK_THAT(frames.notices(),
             Catch::VectorContains(std::string(
                 "1 control interval of which a needed topic is missing: mpm/cv of 1")));
}

// 2.7 and above: eight times 0.3 beyond 0.3.
TEST_CASE(
    "What an input cannot be by its limits is marked in a recording, and kept by who keeps it") {
  Bench bench;
  write_recording(bench, "a.mcap", all_columns());
  bench.unit.mv[0].limits = {0.0, 0.3};
  const auto usable = [&bench](files::Purpose purpose) {
    bag::McapFrames frames({bench.folder.file("a.mcap")}, bench.unit, purpose);
    int count = 0;
    for (Frame frame; frames.next(frame);) count += frame[SignalKind::kMv].usable(0) ? 1 : 0;
    return count;
  };
  CHECK(usable(files::Purpose::kJudge) == 27);
  CHECK(usable(files::Purpose::kKeep) == 40);
}

}  // namespace
}  // namespace mpm::test
