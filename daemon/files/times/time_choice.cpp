#include "daemon/files/times/time_choice.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "config/finding.hpp"
#include "daemon/files/times/local_times.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

/// From here on (1980) a time is one of a calendar rather than seconds of a run.
constexpr std::int64_t kCalendarNs = 315'532'800'000'000'000;

[[noreturn]] void refuse(const std::string& option, const std::string& message) {
  throw config::InputError({option, 0, 0, config::Severity::kError, "", message});
}

/// 28/3/2026 has the day first, whatever the file is like; 4/3/2026 may be either.
std::optional<std::int64_t> in_the_only_order(const std::string& text,
                                              const std::shared_ptr<const TimeZone>& zone) {
  std::string problem;
  const auto day_first = LocalTimes({zone, nullptr}, DateOrder::kDayFirst).read(text, "", problem);
  const auto month_first =
      LocalTimes({zone, nullptr}, DateOrder::kMonthFirst).read(text, "", problem);
  if (day_first && month_first && *day_first != *month_first) return std::nullopt;
  return day_first ? day_first : month_first;
}

std::int64_t time_of(const std::string& option, const std::string& text, const TimeStyle& times) {
  std::string problem;
  std::optional<std::int64_t> time_ns = LocalTimes({times.zone, nullptr}).read(text, "", problem);
  if (!time_ns && times.format) time_ns = LocalTimes(times).read(text, "", problem);
  if (!time_ns && !times.format) time_ns = in_the_only_order(text, times.zone);
  if (!time_ns) refuse(option, "'" + text + "' " + problem);
  return *time_ns;
}

Stretch stretch_of(const std::string& option, const std::string& text, const TimeStyle& times) {
  const std::size_t slashes = static_cast<std::size_t>(std::count(text.begin(), text.end(), '/'));
  if (slashes != 1) refuse(option, "'" + text + "' is no stretch of time: write A/B, two times");
  const std::size_t slash = text.find('/');
  const Stretch stretch{time_of(option, text.substr(0, slash), times),
                        time_of(option, text.substr(slash + 1), times)};
  if (stretch.until_ns <= stretch.from_ns) refuse(option, "'" + text + "' ends before it begins");
  return stretch;
}

std::string shown(std::int64_t time_ns) {
  return time_ns < kCalendarNs ? seconds_text(time_ns) + " s" : utc_text(time_ns);
}

}  // namespace

TimeChoice::TimeChoice(const TimeChoiceText& text, const TimeStyle& times) {
  if (!text.from.empty()) from_ns_ = time_of("--from", text.from, times);
  if (!text.until.empty()) until_ns_ = time_of("--until", text.until, times);
  if (from_ns_ && until_ns_ && *until_ns_ <= *from_ns_)
    refuse("--until", "'" + text.until + "' is not after --from '" + text.from + "'");
  for (const std::string& exclude : text.exclude)
    excluded_.push_back(stretch_of("--exclude", exclude, times));
}

bool TimeChoice::takes(std::int64_t time_ns) const {
  if ((from_ns_ && time_ns < *from_ns_) || (until_ns_ && time_ns >= *until_ns_)) return false;
  return std::none_of(excluded_.begin(), excluded_.end(), [time_ns](const Stretch& stretch) {
    return time_ns >= stretch.from_ns && time_ns < stretch.until_ns;
  });
}

void UsedStretches::note(std::int64_t time_ns, bool taken) {
  if (taken && !open_) stretches_.push_back({time_ns, time_ns});
  if (taken) stretches_.back().until_ns = std::max(stretches_.back().until_ns, time_ns);
  open_ = taken;
}

std::string nothing_chosen(std::int64_t first_ns, std::int64_t last_ns) {
  return "--from, --until and --exclude leave no row of it: it goes from " + shown(first_ns) +
         " to " + shown(last_ns);
}

}  // namespace mpm::files
