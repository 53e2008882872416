#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/files/csv/csv_rows.hpp"
#include "tests/io/historians/exports.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

namespace {

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
