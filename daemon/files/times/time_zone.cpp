#include "daemon/files/times/time_zone.hpp"

#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "config/finding.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kOneDay = 86400;

// The C library knows one zone at a time; most programs have no more.
void activate(const std::string& name) {
  static std::string active;
  if (active == name) return;
  setenv("TZ", (":" + name).c_str(), 1);
  tzset();
  active = name;
}

}  // namespace

TimeZone::TimeZone(const std::string& name) : name_(name) {
  // The C library takes a name that it does not know for UTC.
  const char* folder = std::getenv("TZDIR");
  const std::filesystem::path zones(folder == nullptr ? "/usr/share/zoneinfo" : folder);
  std::error_code ignored;
  if (name.empty() || name.front() == '/' || name.find("..") != std::string::npos ||
      !std::filesystem::is_regular_file(zones / name, ignored))
    throw config::InputError({"", 0, 0, config::Severity::kError, "",
                              "no time zone '" + name + "' in " + zones.string() +
                                  "; they are called like Europe/Berlin"});
  activate(name_);
}

int TimeZone::offset_s(std::int64_t utc_s) const {
  activate(name_);
  const std::time_t time = utc_s;
  std::tm local{};
  localtime_r(&time, &local);
  return static_cast<int>(local.tm_gmtoff);
}

TimeZone::Moments TimeZone::moments(std::int64_t local_s) const {
  Moments moments;
  // No zone changes twice within two days, so one of the offsets on either side applies.
  for (const std::int64_t around : {local_s - kOneDay, local_s + kOneDay}) {
    const int offset = offset_s(around);
    const std::int64_t utc_s = local_s - offset;
    if (offset_s(utc_s) != offset) continue;
    if (moments.count == 1 && moments.utc_s[0] == utc_s) continue;
    moments.utc_s[static_cast<std::size_t>(moments.count++)] = utc_s;
  }
  if (moments.count == 2 && moments.utc_s[1] < moments.utc_s[0])
    std::swap(moments.utc_s[0], moments.utc_s[1]);
  return moments;
}

}  // namespace mpm::files
