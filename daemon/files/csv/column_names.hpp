#pragma once

#include <string>
#include <string_view>

/// How columns of data files are called, in English and German.
namespace mpm::files {

/// Lower case, without blanks, signs, quotes, and what stands in brackets at the end: `Time Stamp
/// [UTC]` is `timestamp`.
[[nodiscard]] std::string plain_name(std::string_view name);

/// Names of a time wherever they stand, and those that only a first column has (`t`, `ts`).
[[nodiscard]] bool is_time_name(std::string_view name);
[[nodiscard]] bool is_short_time_name(std::string_view name);
/// The zone that the name of a time column tells, as the database of zones calls it: UTC for `Time
/// (UTC)`, `timestamp_utc`, `Zeit [GMT]`, Etc/GMT-1 for `Time (UTC+1)`, Europe/Berlin for `Time
/// (Europe/Berlin)`, which may be none; empty where it tells none.
[[nodiscard]] std::string zone_in_name(std::string_view name);
/// A date beside which there may be a time of day, and that.
[[nodiscard]] bool is_date_name(std::string_view name);
[[nodiscard]] bool is_clock_name(std::string_view name);
/// Of a table with one row for each tag and time; the smaller the surer, -1 for other names.
[[nodiscard]] int tag_name_rank(std::string_view name);
[[nodiscard]] int value_name_rank(std::string_view name);
/// Of such a table with a column for each type of value (`intvalue`, `floatvalue` ...).
[[nodiscard]] bool is_typed_value_name(std::string_view name);

}  // namespace mpm::files
