#include "daemon/files/csv/column_names.hpp"

#include <catch2/catch.hpp>

using namespace mpm::files;

TEST_CASE("Names are compared without case, blanks, signs and units") {
  CHECK(plain_name("Time Stamp [UTC]") == "timestamp");
  CHECK(plain_name("Datum/Uhrzeit") == "datumuhrzeit");
  CHECK(plain_name("IP_TREND_VALUE") == "iptrendvalue");
  CHECK(plain_name("(x)") == "x");
}

TEST_CASE("Columns are known by their names") {
  for (const char* name : {"time", "Timestamp", "Date Time", "t_stamp", "Zeitstempel", "Time (UTC)",
                           "IP_TREND_TIME", "TimeString", "time_s"})
    CHECK(is_time_name(name));
  CHECK(is_short_time_name("TS"));
  CHECK(is_short_time_name("t_s"));
  CHECK_FALSE(is_time_name("TS"));
  CHECK_FALSE(is_time_name("residence time 2"));
  CHECK(is_date_name("Datum"));
  CHECK(is_clock_name("Uhrzeit"));
  CHECK(tag_name_rank("TagName") >= 0);
  CHECK(tag_name_rank("tag") < tag_name_rank("NAME"));
  CHECK(value_name_rank("Value") < value_name_rank("vValue"));
  CHECK(value_name_rank("FIC101.PV") == -1);
}

TEST_CASE("The name of a time column may tell its zone") {
  for (const char* name :
       {"Timestamp (UTC)", "Timestamp [UTC]", "Time (GMT)", "Time UTC", "UTC Time", "timestamp_utc",
        "DateTimeUTC", "TimestampUTC", "time (utc+0)", "UTC"})
    CHECK(zone_in_name(name) == "UTC");
  CHECK(zone_in_name("Zeit (UTC+1)") == "Etc/GMT-1");
  CHECK(zone_in_name("Time (GMT-05:00)") == "Etc/GMT+5");
  CHECK(zone_in_name("Time (Europe/Berlin)") == "Europe/Berlin");
  for (const char* name : {"", "time", "Timestamp", "Time (s)", "Time (UTC+5:30)", "Time (local)",
                           "utcoffset", "outcome", "Time UTC offset", "Timestamp (yyyy/mm/dd)"}) {
    CAPTURE(name);
    CHECK(zone_in_name(name).empty());
  }
  CHECK(zone_in_name(std::string(1'000'000, 'a') + " (UTC)").empty());
}
