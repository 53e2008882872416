#include "daemon/files/times/local_times.hpp"

#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/times/serial_dates.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kHalfHourNs = 1800 * kSecondNs;

/// 20260328140500
bool looks_compact(std::string_view text) {
  return text.size() == 14 && (text.starts_with("19") || text.starts_with("20")) &&
         text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool may_be_a_date(const CalendarTime& written) {
  return written.local(DateOrder::kDayFirst) || written.local(DateOrder::kMonthFirst);
}

}  // namespace

std::optional<std::int64_t> LocalTimes::read(std::string_view text, std::string_view series,
                                             std::string& problem) {
  const std::optional<CalendarTime> written =
      style_.format ? style_.format->parse(text) : parse_calendar(text);
  if (!written && style_.format) {
    problem = "is not written as --time-format '" + style_.format->pattern() + "' says";
    return std::nullopt;
  }
  if (!written) return read_number(text, problem);
  if (written->two_numbers && order_ == DateOrder::kUnknown && may_be_a_date(*written)) {
    problem =
        "may be day or month first, and nothing in the file tells: say it with --time-format '" +
        format_like(text, DateOrder::kDayFirst) + "' or '" +
        format_like(text, DateOrder::kMonthFirst) + "'";
    return std::nullopt;
  }
  const std::optional<LocalTime> local = written->local(order_);
  if (!local) {
    problem = "is no day of the calendar";
    if (written->two_numbers && order_ != DateOrder::kUnknown)
      problem += ": the dates of the file have the " + std::string(name_of(order_)) + " first";
    return std::nullopt;
  }
  dates_ = true;
  if (!written->zone_s) return read_local(*local, series, problem);
  const auto time_ns = moment_ns(local->seconds - *written->zone_s, local->fraction_ns);
  if (!time_ns) problem = "is out of range";
  return time_ns;
}

std::optional<std::int64_t> LocalTimes::read_number(std::string_view text, std::string& problem) {
  const std::optional<EpochTime> epoch = parse_epoch(text);
  const std::optional<std::int64_t> time_ns =
      epoch ? std::optional(epoch->time_ns) : parse_seconds(text, problem);
  if (time_ns && dates_) {
    problem = "is a number, where the times before it are dates";
    return std::nullopt;
  }
  if (!time_ns)
    if (std::string ticks = tick_problem(text); !ticks.empty()) problem = std::move(ticks);
  if (!time_ns && looks_compact(text))
    problem =
        "is no time that tells itself: say with --time-format '%Y%m%d%H%M%S' how it is written";
  if (epoch) unit_ = epoch->unit;
  if (!time_ns && problem == kNoTime) problem += ", or say how it is written with --time-format";
  return time_ns;
}

std::optional<std::int64_t> LocalTimes::read_local(const LocalTime& local, std::string_view series,
                                                   std::string& problem) {
  if (!style_.zone) {
    problem =
        "is a local time: add its zone, Z or +hh:mm, or name it with --time-zone, such as "
        "Europe/Berlin or UTC";
    return std::nullopt;
  }
  if (!moment_ns(local.seconds, 0)) {
    problem = "is out of range";
    return std::nullopt;
  }
  const TimeZone::Moments moments = style_.zone->moments(local.seconds);
  if (moments.count == 0) {
    problem =
        "does not exist in " + style_.zone->name() +
        ": the clock goes forward over it; if the "
        "file's clock never does, name a zone without summer time, such as Etc/GMT-1 for UTC+1";
    return std::nullopt;
  }
  ++local_;
  auto found = series_.find(series);
  if (found == series_.end()) found = series_.emplace(series, Series{}).first;
  Series& rows = found->second;
  std::int64_t time_ns = moments.utc_s[0] * kSecondNs + local.fraction_ns;
  if (moments.count == 2) {
    ++twice_;
    const bool past = rows.begun && (time_ns < rows.last_ns ||
                                     (time_ns == rows.last_ns && rows.step_ns > kHalfHourNs));
    if (past) time_ns = moments.utc_s[1] * kSecondNs + local.fraction_ns;
  }
  if (rows.begun && time_ns > rows.last_ns) rows.step_ns = time_ns - rows.last_ns;
  rows.last_ns = time_ns;
  rows.begun = true;
  return time_ns;
}

void LocalTimes::restart() {
  series_.clear();
  local_ = twice_ = 0;
  unit_ = nullptr;
  dates_ = false;
}

std::vector<std::string> LocalTimes::notices() const {
  std::vector<std::string> notices;
  if (unit_ != nullptr)
    notices.push_back("times are read as " + std::string(unit_) + " since 1970");
  if (local_ > 0)
    notices.push_back("times without a zone are read as those of " + style_.zone->name() +
                      style_.zone_said);
  if (twice_ > 0)
    notices.push_back(counted(twice_, "time") + " in an hour that " + style_.zone->name() +
                      " has twice, taken in the order of the rows");
  return notices;
}

}  // namespace mpm::files
