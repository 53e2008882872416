#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/load_unit.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/files/csv/csv_rows.hpp"
#include "daemon/files/times/time_text.hpp"

// Every expected number stands in the file by its side and was written down by hand from there: the
// values as they are, the times less one hour (Berlin in March is UTC+1).

using namespace mpm;
using namespace mpm::files;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string path(const std::string& file) {
  return std::string(MPM_SOURCE_DIR) + "/tests/io/historians/" + file;
}

/// What FIC101.PV and TIC102.PV are in a file. Qualities: g, u, b.
struct Export {
  std::string file;
  std::string zone;  ///< of --time-zone; empty = none is needed
  std::string first, last;
  std::vector<double> fic;
  std::string fic_qualities;
  std::vector<double> tic;
  std::string tic_qualities;
  int unusable = 0;
  double sample_time_s = 60.0;
  std::string format = {};  ///< of --time-format

  [[nodiscard]] TimeStyle times() const {
    return {zone.empty() ? nullptr : std::make_shared<TimeZone>(zone),
            format.empty() ? nullptr : std::make_shared<TimeFormat>(format)};
  }
};

const char* const kBerlin = "Europe/Berlin";
const char* const kAt1305 = "2026-03-26T13:05:00Z";
const char* const kAt1306 = "2026-03-26T13:06:00Z";
const char* const kAt1307 = "2026-03-26T13:07:00Z";

const std::vector<Export>& exports() {
  static const std::vector<Export> all = {
      {"aveva_history_long.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, kNone, 182},
       "gbb",
       2},
      {"aveva_quality_only.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, kNone, 182},
       "ubg",
       1},
      {"aveva_wide_history.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggg",
       {181.5, kNone, 182},
       "gbg",
       1},
      {"pi_datalink_sampled.csv",
       kBerlin,
       "2026-03-28T13:05:00Z",
       "2026-03-28T13:09:00Z",
       {50.25, 50.75, kNone, 51, kNone},
       "ggbgb",
       {181.5, kNone, 182, kNone, kNone},
       "gbgbb",
       5},
      {"pi_names_above.csv",
       kBerlin,
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gg",
       {181.5, kNone},
       "gb",
       1},
      {"pi_web_api_flat.csv",
       "",
       kAt1305,
       kAt1307,
       {50.25, 50.75, kNone},
       "gub",
       {181.5, 181.75, 182},
       "gbu",
       2},
      {"pi_piconfig_long.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, kNone},
       "ggb",
       {181.5, kNone, 182},
       "gbg",
       2},
      {"ignition_wide.csv",
       "",
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggg",
       {181.5, kNone, 182},
       "gbg",
       1},
      {"ignition_tall.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gub",
       {181.5, 181.75, 182},
       "gbb",
       3},
      {"ignition_database.csv",
       "",
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gg",
       {181.5, 181.75},
       "gb",
       1},
      {"ip21_history.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, 181.75, kNone},
       "gbb",
       2},
      {"ip21_trend.csv", "", kAt1305, kAt1306, {50.25, 50.75}, "gg", {181.5, 181.75}, "gb", 1},
      {"phd_confidence.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, 181.75, kNone},
       "gbb",
       2},
      {"experion_quality_columns.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggb",
       {181.5, 181.75, 182},
       "gbg",
       2},
      {"deltav_continuous_history.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gbg",
       {181.5, 181.75, 182},
       "ggb",
       2},
      {"wincc_table_german.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggg",
       {181.5, kNone, 182},
       "gbg",
       1},
      {"wincc_panel_log.csv",
       kBerlin,
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gb",
       {181.5, 181.75},
       "gg",
       1},
      {"pcs7_status_german.csv",
       kBerlin,
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gu",
       {181.5, 181.75},
       "gb",
       1},
      {"exaquantum_quality_after_value.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, 181.75, kNone},
       "gbb",
       2},
      {"proficy_data_section.csv",
       kBerlin,
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gg",
       {181.5, 181.75},
       "gb",
       1},
      {"excel_us.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggg",
       {181.5, kNone, 182},
       "gbg",
       1},
      {"excel_german_two_columns.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "ggg",
       {181.5, kNone, 182},
       "gbg",
       1},
      {"excel_quality_underscore.csv",
       kBerlin,
       kAt1305,
       kAt1307,
       {50.25, 50.75, 51},
       "gug",
       {181.5, 181.75, 182},
       "gbg",
       1},
      {"excel_few_days_month_first.csv",
       kBerlin,
       "2026-03-04T22:58:00Z",
       "2026-03-04T23:01:00Z",
       {50.25, 50.75, 51, 51.25},
       "gggg",
       {181.5, 181.75, 182, 182.25},
       "gggg",
       0},
      // Berlin in summer is UTC+2.
      {"excel_dates_going_on.csv",
       kBerlin,
       "2026-04-12T21:58:00Z",
       "2026-04-30T22:01:00Z",
       {50.25, 50.75, 51, 51.25},
       "gggg",
       {181.5, 181.75, 182, 182.25},
       "gggg",
       0},
      {"excel_ambiguous.csv",
       kBerlin,
       "2026-04-03T12:05:00Z",
       "2026-04-03T12:06:00Z",
       {50.25, 50.75},
       "gg",
       {181.5, 181.75},
       "gg",
       0,
       60.0,
       "%d/%m/%Y %H:%M"},
      {"excel_ambiguous.csv",
       "UTC",
       "2026-03-04T14:05:00Z",
       "2026-03-04T14:06:00Z",
       {50.25, 50.75},
       "gg",
       {181.5, 181.75},
       "gg",
       0,
       60.0,
       "%m/%d/%Y %H:%M"},
      {"spanish_header.csv",
       kBerlin,
       kAt1305,
       kAt1306,
       {50.25, 50.75},
       "gg",
       {181.5, 181.75},
       "gg",
       0},
      // 02:30 in summer, 02:00 and 02:30 in winter time, 03:00: half an hour each.
      {"dst_hour_twice.csv",
       kBerlin,
       "2026-10-25T00:30:00Z",
       "2026-10-25T02:00:00Z",
       {50.25, 50.75, 51, 51.25},
       "gggg",
       {181.5, 181.75, 182, 182.25},
       "gggg",
       0,
       1800.0},
  };
  return all;
}

config::UnitConfig unit(double sample_time_s) {
  const auto loaded =
      config::load_unit_text("unit: t\nsample_time: " + std::to_string(sample_time_s) +
                                 "\nsignals: {mv: FIC101.PV, cv: TIC102.PV}\n"
                                 "model: {channels: [{cv: TIC102.PV, mv: FIC101.PV, gain: 1}]}\n",
                             "u.yaml");
  REQUIRE(loaded.ok());
  return loaded.config;
}

/// One signal of a file, row by row.
struct Signal {
  std::vector<double> values;
  std::string qualities;

  void add(const SignalBlock& block, int index) {
    values.push_back(block.values(index));
    qualities += "gub"[static_cast<int>(block.quality[static_cast<std::size_t>(index)])];
  }
  [[nodiscard]] int unusable() const {
    int count = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      count += qualities[i] == 'b' || !std::isfinite(values[i]) ? 1 : 0;
    return count;
  }
};

void check(const Signal& signal, const std::vector<double>& values, const std::string& qualities) {
  REQUIRE(signal.values.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CAPTURE(i);
    if (std::isnan(values[i]))
      CHECK(std::isnan(signal.values[i]));
    else
      CHECK(signal.values[i] == values[i]);
  }
  CHECK(signal.qualities == qualities);
}

double median_step_s(const std::vector<std::int64_t>& times_ns) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) steps.push_back(times_ns[i] - times_ns[i - 1]);
  std::sort(steps.begin(), steps.end());
  return static_cast<double>(steps[steps.size() / 2]) * 1e-9;
}

void check(const Export& given, const Signal& fic, const Signal& tic,
           const std::vector<std::int64_t>& times_ns) {
  check(fic, given.fic, given.fic_qualities);
  check(tic, given.tic, given.tic_qualities);
  CHECK(fic.unusable() + tic.unusable() == given.unusable);
  REQUIRE(times_ns.size() == given.fic.size());
  CHECK(utc_text(times_ns.front()) == given.first);
  CHECK(utc_text(times_ns.back()) == given.last);
  CHECK(median_step_s(times_ns) == Approx(given.sample_time_s));
}

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

TEST_CASE("Exports are read as detect and diagnose read them") {
  for (const Export& given : exports()) {
    CAPTURE(given.file, given.format);
    CsvReader reader(path(given.file), unit(given.sample_time_s), given.times());
    CHECK(reader.holds("FIC101.PV"));
    CHECK(reader.holds("TIC102.PV"));
    Signal fic, tic;
    std::vector<std::int64_t> times_ns;
    Frame frame;
    while (reader.next(frame)) {
      fic.add(frame[SignalKind::kMv], 0);
      tic.add(frame[SignalKind::kCv], 0);
      times_ns.push_back(frame.source_time_ns);
    }
    check(given, fic, tic, times_ns);
  }
}

TEST_CASE("Exports are read as convert and info read them, without a unit file") {
  for (const Export& given : exports()) {
    CAPTURE(given.file, given.format);
    CsvRows rows(path(given.file), given.times());
    std::map<std::string, Signal> signals;
    std::vector<std::int64_t> times_ns;
    Frame frame;
    while (rows.next(frame)) {
      // Rows of bookkeeping that only have tags of their own.
      const SignalBlock& block = frame[SignalKind::kAux];
      const bool about_us =
          std::any_of(rows.columns().begin(), rows.columns().end(), [&](const Column& column) {
            return (column.tag == "FIC101.PV" || column.tag == "TIC102.PV") &&
                   (std::isfinite(block.values(column.index)) ||
                    given.file != "wincc_panel_log.csv");
          });
      if (!about_us) continue;
      times_ns.push_back(frame.source_time_ns);
      for (const Column& column : rows.columns()) signals[column.tag].add(block, column.index);
    }
    check(given, signals["FIC101.PV"], signals["TIC102.PV"], times_ns);
    if (given.file != "wincc_panel_log.csv") CHECK(rows.columns().size() == 2);
  }
}

TEST_CASE("There are twenty layouts or more") {
  std::set<std::string> files;
  for (const Export& given : exports()) files.insert(given.file);
  CHECK(files.size() >= 20);
}

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
