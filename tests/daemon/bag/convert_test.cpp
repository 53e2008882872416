#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "config/finding.hpp"
#include "config/load_unit.hpp"
#include "daemon/bag/convert.hpp"
#include "daemon/bag/info_text.hpp"
#include "daemon/bag/mcap_frame_writer.hpp"
#include "daemon/bag/open_recording.hpp"
#include "daemon/mcap/read/ordered_reader.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "tests/daemon/bag/bench.hpp"
#include "tests/daemon/mcap/files.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

const std::string kShell = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";

TEST_CASE("MCAP, CSV, MCAP, CSV: not a bit is lost, in either layout and any zone") {
  Bench bench;
  {
    bag::McapFrameWriter writer(bench.folder.file("a.mcap"), bench.unit, all_columns());
    for (const Frame& frame : any_frames(bench.unit, 700)) writer.write(frame);
    writer.finish();
  }
  bag::ConvertOptions options;
  options.layout = GENERATE(files::CsvLayout::kWide, files::CsvLayout::kLong);
  const auto times = GENERATE(as<std::string>{}, "utc", "seconds", "America/St_Johns");
  options.seconds = times == "seconds";
  if (times.find('/') != std::string::npos)
    options.output_zone = std::make_shared<files::TimeZone>(times);
  const bag::ConvertReport first = bench.convert("a.mcap", "a.csv", options);
  CHECK(first.rows == 700);
  CHECK(first.signals == 7);
  CHECK(first.values + first.missing == 7U * 700U);
  CHECK(first.missing > 0);
  CHECK(first.uncertain > 0);
  CHECK(first.bad > 0);
  const bag::ConvertReport back = bench.convert("a.csv", "b.mcap", bench.with_unit());
  CHECK(back.values == first.values);
  CHECK(back.bad == first.bad);
  static_cast<void>(bench.convert("b.mcap", "b.csv", options));
  CHECK(bench.text("a.csv") == bench.text("b.csv"));

  // The values themselves, bit by bit.
  const auto frames = bag::open_recording(bench.folder.file("b.mcap"), bench.unit);
  Frame read;
  for (const Frame& frame : any_frames(bench.unit, 700)) {
    REQUIRE(frames->next(read));
    REQUIRE(read.source_time_ns == frame.source_time_ns);
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv}) {
      for (int i = 0; i < frame[kind].size(); ++i) {
        const double a = frame[kind].values(i), b = read[kind].values(i);
        const bool same = std::isnan(a)
                              ? std::isnan(b)
                              : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        REQUIRE(same);
        REQUIRE(frame[kind].quality[static_cast<std::size_t>(i)] ==
                read[kind].quality[static_cast<std::size_t>(i)]);
      }
    }
  }
  CHECK_FALSE(frames->next(read));
}

TEST_CASE("A historian's export becomes a recording and says what was left out") {
  Bench bench;
  write_file(bench.folder.file("h.csv"),
             "\xEF\xBB\xBF"
             "Time;u;d,1;y;z;other\r\n;%;;degC;;\r\n"
             "2024-10-27 02:58:00;1,5;2;3;Bad;9\r\n"
             "2024-10-27 02:59:00;1,5;No Data;3;4;9\r\n"
             "2024-10-27 02:00:00;1,25;2;3;4;9\r\n"  // the clock went back
             "27.10.2024 02:01:00;1;2;3;I/O Timeout;9\r\n"
             "2024-10-27 02:02:00;1");
  bag::ConvertOptions options = bench.with_unit();
  CHECK(bench.error("h.csv", "h.mcap", options)
            .find("h.csv:3:1: error: '2024-10-27 02:58:00' is a "
                  "local time") != std::string::npos);
  options.input_times.zone = std::make_shared<files::TimeZone>("Europe/Berlin");
  const bag::ConvertReport report = bench.convert("h.csv", "h.mcap", options);
  CHECK(report.rows == 4);
  CHECK(report.signals == 4);
  CHECK(report.missing == 3);
  std::string notices;
  for (const std::string& notice : report.notices) notices += notice + '\n';
  CHECK(notices.find("other") != std::string::npos);
  CHECK(notices.find("line 7 is cut off") != std::string::npos);
  CHECK(notices.find("4 times in an hour that Europe/Berlin has twice") != std::string::npos);
  bag::ConvertOptions out;
  static_cast<void>(bench.convert("h.mcap", "back.csv", out));
  CHECK(bench.text("back.csv") ==
        "time,u,\"d,1\",y,z\n"
        "2024-10-27T00:58:00Z,1.5,2,3,\n"
        "2024-10-27T00:59:00Z,1.5,,3,4\n"
        "2024-10-27T01:00:00Z,1.25,2,3,4\n"
        "2024-10-27T01:01:00Z,1,2,3,\n");
  out.output_zone = std::make_shared<files::TimeZone>("Europe/Berlin");
  static_cast<void>(bench.convert("h.mcap", "back.csv", out));
  CHECK(bench.text("back.csv").find("2024-10-27T02:59:00+02:00") != std::string::npos);
  CHECK(bench.text("back.csv").find("2024-10-27T02:00:00+01:00") != std::string::npos);
}

TEST_CASE("What cannot be converted is refused in one line and leaves no file") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), "time,u,d,1,y,z\n");
  write_file(bench.folder.file("old.csv"), "time,u\n-60,1\n0,2\n");
  write_file(bench.folder.file("gap.csv"),
             "time,u\n2024-03-31 01:59:00,1\n2024-03-31 02:30:00,2\n");
  CHECK(bench.error("none.csv", "x.csv", {}).find("no such file") != std::string::npos);
  CHECK(bench.error("old.csv", "x.mcap", {}).find("--config") != std::string::npos);
  bag::ConvertOptions options;
  options.input_times.zone = std::make_shared<files::TimeZone>("Europe/Berlin");
  CHECK(bench.error("gap.csv", "x.csv", options)
            .find("gap.csv:3:1: error: '2024-03-31 02:30:00' "
                  "does not exist in Europe/Berlin") != std::string::npos);
  CHECK(bench.error("old.csv", "no/folder.csv", {}).find("there is no folder") !=
        std::string::npos);
  CHECK_THROWS_AS(files::TimeZone("Europe/Atlantis"), config::InputError);
  CHECK_THROWS_AS(files::TimeZone("../../etc/passwd"), config::InputError);
  write_file(bench.folder.file("before.csv"), "time,u,\"d,1\",y,z\n-60,1,1,1,1\n0,2,2,2,2\n");
  CHECK(bench.error("before.csv", "x.mcap", bench.with_unit()).find("before 1970") !=
        std::string::npos);
}

TEST_CASE("Detect gives the same from MCAP as from CSV") {
  TemporaryFolder folder;
  const std::string csv = folder.file("run.csv"), mcap = folder.file("run.mcap");
  const auto scenario = GENERATE(as<std::string>{}, "hidden_gain", "none");
  REQUIRE(run({"mpmsim", "--config", kShell, "--scenario", scenario, "--samples", "1500", "--seed",
               "5", "--start-time", "0", "--csv", csv},
              folder.file("o"), folder.file("e")) == 0);
  REQUIRE(run({"mpm", "convert", csv, mcap, "--config", kShell}, folder.file("o"),
              folder.file("e")) == 0);
  for (const std::string& data : {csv, mcap})
    REQUIRE(run({"mpm", "detect", "--config", kShell, "--data", data, "--json",
                 "--journal-every-sample", data + ".jsonl"},
                data + ".json", folder.file("e")) == 0);
  CHECK(read_file(csv + ".json") == read_file(mcap + ".json"));
  const bool identical = read_file(csv + ".jsonl") == read_file(mcap + ".jsonl");
  CHECK(identical);
  CHECK(read_file(csv + ".jsonl").size() > 100'000);
}

TEST_CASE("Of several units the one of the unit file is taken") {
  Bench bench;
  // Two recordings in one: the second unit has other values.
  config::UnitConfig other = bench.unit;
  other.unit = "other";
  bag::McapFrameWriter a(bench.folder.file("a.mcap"), bench.unit, all_columns());
  bag::McapFrameWriter b(bench.folder.file("b.mcap"), other, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 30)) {
    a.write(frame);
    b.write(frame);
  }
  a.finish();
  b.finish();
  mcap::Writer both(bench.folder.file("both.mcap"));
  for (const char* name : {"a.mcap", "b.mcap"}) {
    const auto schema = both.add_schema("mpm::Sample", "omgidl", "");
    const auto layout = both.add_schema("mpm::Layout", "omgidl", "");
    std::map<std::string, mcap::ChannelId> channels;
    const auto source = mcap::open_messages(bench.folder.file(name));
    mcap::Message message;
    while (source->next(message)) {
      auto& id = channels[message.channel->topic];
      if (id == 0)
        id = both.add_channel(message.schema->name == "mpm::Sample" ? schema : layout,
                              message.channel->topic, "cdr");
      both.write(id, message.log_time_ns, message.publish_time_ns, message.data);
    }
  }
  both.finish();
  CHECK(bench.error("both.mcap", "x.csv", {})
            .find("holds several units; pick one with --unit: 'other', 'small'") !=
        std::string::npos);
  bag::ConvertOptions options;
  options.unit_name = "other";
  CHECK(bench.convert("both.mcap", "other.csv", options).rows == 30);
  CHECK(bench.convert("both.mcap", "small.csv", bench.with_unit()).rows == 30);
  CHECK(bench.text("other.csv") == bench.text("small.csv"));
  other.unit = "third";
  try {
    static_cast<void>(bag::open_recording(bench.folder.file("both.mcap"), other));
    FAIL("taken");
  } catch (const config::InputError& error) {
    CHECK(std::string(error.what())
              .find("no samples of unit 'third'; its units are 'other', "
                    "'small'") != std::string::npos);
  }
  const bag::FileInfo info = bag::inspect(bench.folder.file("both.mcap"));
  CHECK(info.units.size() == 2);
  CHECK(info.index_problem.empty());
  CHECK(info.times.count == 2 * (6 + 6 * 30));
  const bag::SampleTally& mv = info.units.at("small").samples.at(SignalKind::kMv);
  CHECK(mv.times.gaps == 1);
  CHECK(mv.times.missing == 5);
  CHECK(mv.times.longest_gap_ns > 359'000'000'000);
  CHECK(mv.signals.at(0).tag == "u");
  const bag::SignalTally& u = mv.signals.at(0);
  CHECK(u.good + u.uncertain + u.bad + u.missing == 30);
}

TEST_CASE("Info bounds what times that may be anything make longer than it can count") {
  bag::FileInfo info;
  info.path = "a.csv";
  info.times.add(0);
  info.times.add_gap(std::numeric_limits<std::int64_t>::min(),
                     std::numeric_limits<std::int64_t>::max(), 5);
  CHECK(to_text(info).find("1 gap, 5 missing, the longest more than 106752.0 days at ") !=
        std::string::npos);
  info.times.longest_gap_ns = 90'000'000'000;
  CHECK(to_text(info).find("5 missing, the longest 90 s at ") != std::string::npos);
}

TEST_CASE("Info tells a CSV's step, gaps and qualities, and a torn recording's tear") {
  Bench bench;
  write_file(bench.folder.file("a.csv"),
             "time,u,u.quality,y\n0,1,good,2\n10,1,uncertain,\n20,1,bad,3\n50,1,good,4\n");
  const bag::FileInfo info = bag::inspect(bench.folder.file("a.csv"));
  CHECK(info.step_s == 10.0);
  CHECK(info.times.count == 4);
  CHECK(info.times.gaps == 1);
  CHECK(info.times.missing == 2);
  CHECK(info.times.longest_gap_at_ns == 20'000'000'000);
  REQUIRE(info.signals.size() == 2);
  CHECK(info.signals[0].good == 2);
  CHECK(info.signals[0].uncertain == 1);
  CHECK(info.signals[0].bad == 1);
  CHECK(info.signals[1].missing == 1);
  CHECK(to_json(info)["gaps"]["longest_at"] == "1970-01-01T00:00:20Z");

  bag::McapFrameWriter a(bench.folder.file("a.mcap"), bench.unit, all_columns());
  for (const Frame& frame : any_frames(bench.unit, 30)) a.write(frame);
  a.finish();
  const std::string bytes = bench.text("a.mcap");
  write_file(bench.folder.file("torn.mcap"), bytes.substr(0, bytes.size() - 50));
  const bag::FileInfo torn = bag::inspect(bench.folder.file("torn.mcap"));
  CHECK(torn.times.count == 6 + 6 * 30);
  CHECK(torn.index_problem == "the file has no end");
  CHECK(to_text(torn).find("mpm recover") != std::string::npos);
  std::string wrong = bytes;
  wrong[bytes.size() - 200] = static_cast<char>(wrong[bytes.size() - 200] ^ 4);  // in the summary
  write_file(bench.folder.file("wrong.mcap"), wrong);
  CHECK(bag::inspect(bench.folder.file("wrong.mcap")).index_problem.find("CRC") !=
        std::string::npos);
}

TEST_CASE("Info tells where a CSV's clock goes back, and times without rounding") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), "time,u\n0,1\n0.5,1\n1,1\n0,1\n0.5,1\n0.5,1\n249.5,1\n");
  const bag::FileInfo info = bag::inspect(bench.folder.file("a.csv"));
  const auto json = to_json(info);
  CHECK(json["out_of_order"]["count"] == 2);
  CHECK(json["out_of_order"]["farthest_back_s"] == 1.0);
  CHECK(json["out_of_order"]["farthest_back_at"] == "1970-01-01T00:00:01Z");
  CHECK(json["rows"]["duration_s"] == 249.5);
  CHECK(to_text(info).find("; 2 rows not later than the one before, the farthest back by 1 s after "
                           "1970-01-01T00:00:01Z\n") != std::string::npos);
}

}  // namespace
}  // namespace mpm::test
