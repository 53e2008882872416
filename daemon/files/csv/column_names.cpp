#include "daemon/files/csv/column_names.hpp"

#include <algorithm>
#include <array>
#include <regex>

namespace mpm::files {
namespace {

// No time is called anything longer, and a regular expression takes stack for each letter.
constexpr std::size_t kLongestTimeName = 200;

constexpr std::array<std::string_view, 20> kTimes = {
    "time",      "timestamp",    "datetime",  "dateandtime", "datetimeutc",
    "timeutc",   "utctime",      "localtime", "timestring",  "times",
    "tstamp",    "iptrendtime",  "zeit",      "zeitstempel", "datumuhrzeit",
    "datumzeit", "datumundzeit", "date",      "datum",       "timestamputc"};
constexpr std::array<std::string_view, 2> kShortTimes = {"t", "ts"};
constexpr std::array<std::string_view, 2> kDates = {"date", "datum"};
constexpr std::array<std::string_view, 5> kClocks = {"time", "zeit", "uhrzeit", "timeofday",
                                                     "clock"};
constexpr std::array<std::string_view, 18> kTags = {"tag",
                                                    "tagname",
                                                    "varname",
                                                    "variable",
                                                    "variablenname",
                                                    "archivvariable",
                                                    "pointname",
                                                    "point",
                                                    "tagpath",
                                                    "path",
                                                    "itemid",
                                                    "item",
                                                    "fqn",
                                                    "signal",
                                                    "messstelle",
                                                    "name",
                                                    "id",
                                                    "tagid"};
constexpr std::array<std::string_view, 8> kValues = {"value",        "val",  "varvalue", "tagvalue",
                                                     "iptrendvalue", "wert", "messwert", "vvalue"};

constexpr std::array<std::string_view, 8> kTypedValues = {
    "floatvalue", "intvalue",  "stringvalue", "datevalue",
    "datestring", "realvalue", "doublevalue", "boolvalue"};

template <std::size_t n>
int rank_in(const std::array<std::string_view, n>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), plain_name(name));
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

std::string plain_name(std::string_view name) {
  if (!name.empty() && (name.back() == ']' || name.back() == ')')) {
    const std::size_t open = name.rfind(name.back() == ']' ? '[' : '(');
    if (open != std::string_view::npos && open > 0) name = name.substr(0, open);
  }
  std::string plain;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (c >= 'A' && c <= 'Z')
      plain += static_cast<char>(c - 'A' + 'a');
    else if (letter || static_cast<unsigned char>(c) > 127)
      plain += c;
  }
  return plain;
}

std::string zone_in_name(std::string_view name) {
  if (name.size() > kLongestTimeName) return {};
  static const std::regex utc(
      R"((?:^|[^a-z])(?:utc|gmt)(?:([+-])0?([0-9]{1,2})(?::?([0-9]{2}))?)?[^a-z0-9]*$|^utc ?(?:time|date)|(?:time|timestamp|date)utc$)",
      std::regex::icase);
  static const std::regex named(R"([(\[]\s*([A-Z][A-Za-z_]+/[A-Za-z_+/0-9-]+)\s*[)\]]\s*$)");
  std::cmatch match;
  const char* end = name.data() + name.size();
  if (std::regex_search(name.data(), end, match, named)) return match[1];
  if (!std::regex_search(name.data(), end, match, utc)) return {};
  const int hours = match[2].matched ? std::stoi(match[2]) : 0;
  const bool whole = !match[3].matched || match[3] == "00";
  if (!whole || hours > 14) return {};
  if (hours == 0) return "UTC";
  // These names have the sign of what UTC is later than.
  return std::string("Etc/GMT") + (match[1] == "+" ? '-' : '+') + std::to_string(hours);
}

bool is_time_name(std::string_view name) { return rank_in(kTimes, name) >= 0; }
bool is_short_time_name(std::string_view name) { return rank_in(kShortTimes, name) >= 0; }
bool is_date_name(std::string_view name) { return rank_in(kDates, name) >= 0; }
bool is_clock_name(std::string_view name) { return rank_in(kClocks, name) >= 0; }
int tag_name_rank(std::string_view name) { return rank_in(kTags, name); }
bool is_typed_value_name(std::string_view name) { return rank_in(kTypedValues, name) >= 0; }
int value_name_rank(std::string_view name) { return rank_in(kValues, name); }

}  // namespace mpm::files
