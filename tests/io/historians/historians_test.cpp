#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/files/csv/csv_rows.hpp"
#include "tests/io/historians/exports.hpp"

// Exports of which something is assumed and said, or which are refused.

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

namespace {

std::string error_of(const std::string& file, const TimeStyle& times) {
  try {
    CsvReader reader(path(file), unit(60.0), times);
    Frame frame;
    while (reader.next(frame)) continue;
  } catch (const config::InputError& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string notices_of(const std::string& file, const TimeStyle& times) {
  CsvReader reader(path(file), unit(60.0), times);
  Frame frame;
  while (reader.next(frame)) continue;
  std::string all;
  for (const std::string& notice : reader.notices()) all += notice + '\n';
  return all;
}

}  // namespace

TEST_CASE("Local times are refused without their zone, with the option that helps") {
  for (const Export& given : exports()) {
    CAPTURE(given.file);
    if (given.zone.empty() || given.sample_time_s != 60.0) continue;
    TimeStyle times = given.times();
    times.zone = nullptr;
    const std::string error = error_of(given.file, times);
    CHECK(contains(error, "is a local time"));
    CHECK(contains(error, "--time-zone"));
  }
}

TEST_CASE("A date that may be day or month first is refused, with the option that helps") {
  const TimeStyle berlin{std::make_shared<TimeZone>(kBerlin), nullptr};
  CHECK(error_of("excel_ambiguous.csv", berlin) ==
        path("excel_ambiguous.csv") +
            ":2:1: error: '03/04/2026 14:05' may be day or month first, and nothing in the file "
            "tells: say it with --time-format '%d/%m/%Y %H:%M' or '%m/%d/%Y %H:%M'");
}

TEST_CASE("Day numbers of a spreadsheet are refused rather than taken as seconds") {
  const std::string error = error_of("excel_serial_numbers.csv", {});
  // 46107.58681 - 25569 days since 1970: 2026-03-26, 0.58681 * 24 h = 14:05:00.
  CHECK(contains(error,
                 "excel_serial_numbers.csv:2:1: error: '46107.58681' is a day number of a "
                 "spreadsheet (2026-03-26 14:05:00), not a time: "));
  CHECK(contains(error, "date format"));
  CHECK_THROWS_WITH(CsvRows(path("excel_serial_numbers.csv")), Catch::Contains("a day number"));
  // Said to be seconds they are.
  const TimeStyle seconds{nullptr, std::make_shared<TimeFormat>("%s")};
  CsvRows rows(path("excel_serial_numbers.csv"), seconds);
  Frame frame;
  REQUIRE(rows.next(frame));
  CHECK(frame.source_time_ns == 46'107'586'810'000);
}

TEST_CASE("Ticks of Windows are refused with the moment that they are") {
  // (1774530300 s since 1970 + 11644473600 s since 1601) * 10^7: 2026-03-26 13:05:00 UTC.
  CHECK(contains(error_of("filetime.csv", {}),
                 "filetime.csv:2:1: error: '134190039000000000' is a Windows FILETIME "
                 "(2026-03-26T13:05:00Z), which is not read: "));
}

TEST_CASE("A header that tells the zone is believed, and contradicted aloud") {
  const std::string file = "header_names_utc.csv";
  CHECK(contains(notices_of(file, {}), "those of UTC, as the header 'Timestamp (UTC)' says\n"));
  CHECK(contains(notices_of(file, {std::make_shared<TimeZone>("UTC"), nullptr}), "those of UTC\n"));
  CHECK(contains(
      notices_of(file, {std::make_shared<TimeZone>(kBerlin), nullptr}),
      "those of Europe/Berlin, as --time-zone says; the header 'Timestamp (UTC)' says UTC\n"));
}

TEST_CASE("Names that a historian decorated are read as the unit's tags, by both readers") {
  const std::string file = GENERATE("pi_server_names.csv", "ignition_tag_paths.csv",
                                    "names_with_units.csv", "value_and_quality_columns.csv");
  CAPTURE(file);
  const TimeStyle berlin{std::make_shared<TimeZone>(kBerlin), nullptr};
  const config::UnitConfig known = unit(60.0);
  CsvReader reader(path(file), known, berlin);
  CsvRows rows(path(file), berlin, &known);
  REQUIRE(rows.columns().size() == 2);
  CHECK(rows.columns()[0].tag == "FIC101.PV");
  CHECK(rows.columns()[1].tag == "TIC102.PV");
  Signal fic, tic, fic_row, tic_row;
  std::vector<std::int64_t> times_ns;
  Frame frame, row;
  while (reader.next(frame) && rows.next(row)) {
    fic.add(frame[SignalKind::kMv], 0);
    tic.add(frame[SignalKind::kCv], 0);
    fic_row.add(row[SignalKind::kAux], 0);
    tic_row.add(row[SignalKind::kAux], 1);
    times_ns.push_back(frame.source_time_ns);
  }
  const bool bad_not_missing = file == "value_and_quality_columns.csv";
  const double second = bad_not_missing ? 181.75 : kNone;
  check(fic, {50.25, 50.75, 51}, "ggg");
  check(tic, {181.5, second, 182}, "gbg");
  check(fic_row, {50.25, 50.75, 51}, "ggg");
  check(tic_row, {181.5, second, 182}, "gbg");
  CHECK(utc_text(times_ns.front()) == kAt1305);
  CHECK(contains(notices_of(file, berlin), "columns read as tags of the unit file: "));
}

TEST_CASE("Tags with times of their own are put on the unit's grid, in two ways") {
  const TimeStyle berlin{std::make_shared<TimeZone>(kBerlin), nullptr};
  const auto signals = [&](const std::string& file, Signal& fic, Signal& tic) {
    CsvReader reader(path(file), unit(60.0), berlin);
    Frame frame;
    while (reader.next(frame)) {
      fic.add(frame[SignalKind::kMv], 0);
      tic.add(frame[SignalKind::kCv], 0);
    }
  };
  Signal fic, tic;
  signals("pi_compressed_pairs.csv", fic, tic);
  // 181.5 to 182.5 in two minutes, then to 180.5 in two; lost from 14:10 on, where the value of
  // just before still counts.
  CHECK(tic.values.size() == 6);
  const std::vector<double> line = {181.5, 182, 182.5, 181.5, 180.5};
  for (std::size_t i = 0; i < line.size(); ++i) CHECK(tic.values[i] == Approx(line[i]));
  CHECK(fic.values[2] == Approx(50.25));
  CHECK(fic.values[3] == Approx(51));
  Signal flow, temperature;
  signals("changes_only_long.csv", flow, temperature);
  REQUIRE(flow.values.size() == 24);
  CHECK(flow.values[9] == Approx(50));
  CHECK(flow.values[10] == Approx(60));
  CHECK(flow.values[23] == Approx(70));
  CHECK(temperature.values[5] == 182.25);
  CHECK(temperature.values[7] == 182.25);
  CHECK(temperature.values[8] == 183);
}

TEST_CASE("A table of a historian's database is read by type, path and integrity") {
  const config::UnitConfig known = unit(60.0);
  CsvReader reader(path("ignition_sql_export.csv"), known, {});
  Signal fic, tic;
  Frame frame;
  while (reader.next(frame)) {
    fic.add(frame[SignalKind::kMv], 0);
    tic.add(frame[SignalKind::kCv], 0);
  }
  check(fic, {50.25, 50.75, 51}, "ggg");
  check(tic, {181.5, 181.75, 182}, "gbg");
}

TEST_CASE("Seconds that a spreadsheet cut off come back where the rows tell them") {
  const TimeStyle berlin{std::make_shared<TimeZone>(kBerlin), nullptr};
  CsvReader reader(path("excel_seconds_cut_off.csv"), unit(30.0), berlin);
  Frame frame;
  std::vector<std::int64_t> times_ns;
  while (reader.next(frame)) times_ns.push_back(frame.source_time_ns);
  REQUIRE(times_ns.size() == 8);
  CHECK(utc_text(times_ns[0]) == kAt1305);
  CHECK(utc_text(times_ns[1]) == "2026-03-26T13:05:30Z");
  CHECK(utc_text(times_ns[7]) == "2026-03-26T13:08:30Z");
}

TEST_CASE("Day numbers with the time of day beside them are refused with the way out") {
  const std::string error = error_of("excel_serial_numbers_two_columns.csv", {});
  CHECK(contains(error,
                 "excel_serial_numbers_two_columns.csv:2:1: error: '46107' is a day number of a "
                 "spreadsheet (2026-03-26), not a date: "));
  CHECK(contains(error, "hh:mm:ss"));
}

TEST_CASE("What was assumed is said") {
  const TimeStyle berlin{std::make_shared<TimeZone>(kBerlin), nullptr};
  const auto says = [&](const std::string& file, const std::string& notice) {
    CAPTURE(file);
    CHECK(contains(notices_of(file, berlin), notice));
  };
  says("wincc_table_german.csv", "times without a zone are read as those of Europe/Berlin");
  says("wincc_table_german.csv", "the comma is read as a decimal point");
  says("ignition_wide.csv", "times are read as milliseconds since 1970");
  says("aveva_history_long.csv", "quality is read from OPCQuality\n");
  says("aveva_quality_only.csv", "the quality codes are taken as 0 good, 1 bad, 16 doubtful");
  says("pi_datalink_sampled.csv", "the first column, '', is taken for the time");
  says("pi_datalink_sampled.csv", "line 2 is taken for a row of units and left out");
  says("pi_datalink_sampled.csv",
       "2 values taken as missing, since they are words: Over Range (1)");
  says("proficy_data_section.csv", "line 2 is taken for the header");
  says("excel_few_days_month_first.csv", "dates are read month first");
  says("excel_dates_going_on.csv", "dates are read day first");
  says("excel_us.csv", "1 row without time and values left out");
}
