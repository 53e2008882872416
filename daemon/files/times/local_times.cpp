#include "daemon/files/times/local_times.hpp"

#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kHalfHourNs = 1800 * kNsPerSecond;

}  // namespace

std::optional<std::int64_t> LocalTimes::read(std::string_view text, std::string_view series,
                                             std::string& problem) {
  const std::optional<LocalTime> local = parse_local_time(text);
  if (!local) return parse_time(text, problem);
  if (!zone_) {
    problem =
        "is a local time: add its zone, Z or +hh:mm, or name it to convert, detect, diagnose "
        "or info with --time-zone";
    return std::nullopt;
  }
  const TimeZone::Moments moments = zone_->moments(local->seconds);
  if (moments.count == 0) {
    problem = "does not exist in " + zone_->name() + ": the clock goes forward over it";
    return std::nullopt;
  }
  auto found = series_.find(series);
  if (found == series_.end()) found = series_.emplace(series, Series{}).first;
  Series& rows = found->second;
  std::int64_t time_ns = moments.utc_s[0] * kNsPerSecond + local->fraction_ns;
  if (moments.count == 2) {
    ++twice_;
    const bool past = rows.begun && (time_ns < rows.last_ns ||
                                     (time_ns == rows.last_ns && rows.step_ns > kHalfHourNs));
    if (past) time_ns = moments.utc_s[1] * kNsPerSecond + local->fraction_ns;
  }
  if (rows.begun && time_ns > rows.last_ns) rows.step_ns = time_ns - rows.last_ns;
  rows.last_ns = time_ns;
  rows.begun = true;
  return time_ns;
}

void LocalTimes::restart() {
  series_.clear();
  twice_ = 0;
}

std::string LocalTimes::notice() const {
  if (twice_ == 0) return {};
  return std::to_string(twice_) + " times lie in an hour that " + zone_->name() +
         " has twice; they are taken in the order of the rows";
}

}  // namespace mpm::files
