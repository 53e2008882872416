#include "daemon/files/times/serial_dates.hpp"

#include <catch2/catch.hpp>

using namespace mpm::files;

// date -u -d '2026-03-26 14:05:00' +%s = 1774533900; between 0001-01-01 and 1970 lie 719162 days.
TEST_CASE("Counts of 100 ns are told from other numbers") {
  CHECK(tick_problem("134190075000000000").find("FILETIME (2026-03-26T14:05:00Z)") !=
        std::string::npos);
  CHECK(tick_problem("639101307000000000").find(".NET ticks (2026-03-26T14:05:00Z)") !=
        std::string::npos);
  for (const char* text : {"", "1774533900", "1774533900000000000", "13419007500000000",
                           "934190075000000000", "13419007500000000x"})
    CHECK(tick_problem(text).empty());
}

TEST_CASE("Days of a spreadsheet are told from seconds") {
  const auto is_serial = [](const std::vector<double>& times, double sample_time_s) {
    return !serial_date_problem(times, sample_time_s).empty();
  };
  const std::vector<double> minutes = {46107.5868, 46107.5875, 46107.5882};
  CHECK(is_serial(minutes, 60.0));
  CHECK(is_serial(minutes, 0.0));
  CHECK(is_serial({46107.58, 46107.58, 46107.59}, 60.0));  // with two decimals
  CHECK(is_serial({46107.0, 46108.0, 46109.0}, 86400.0));
  CHECK(is_serial({46107.0, 46107.0417, 46107.0833}, 3600.0));
  // Seconds of a run: far from such days, in whole seconds, or as far apart as the unit says.
  CHECK_FALSE(is_serial({0.0, 0.0007, 0.0014}, 60.0));
  CHECK_FALSE(is_serial({1774530300.0, 1774530360.0}, 60.0));
  CHECK_FALSE(is_serial({46080.0, 46140.0, 46200.0}, 60.0));
  CHECK_FALSE(is_serial({46107.0, 46108.0, 46109.0}, 1.0));
  CHECK_FALSE(is_serial({46107.00, 46107.01, 46107.02}, 0.01));
  CHECK_FALSE(is_serial({46107.0, 46108.0, 46109.0}, 0.0));
  CHECK_FALSE(is_serial({}, 60.0));
  // 46107 days since 30 December 1899 are 2026-03-26 (date -d '1899-12-30 + 46107 days').
  CHECK(serial_date_problem({46107.25}, 60.0).find("(2026-03-26 06:00:00)") != std::string::npos);
}
