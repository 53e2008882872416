#include "daemon/files/times/date_order.hpp"

#include <algorithm>

namespace mpm::files {
namespace {

constexpr int kMonths = 12;

// Clocks that are set to winter time go back so far.
constexpr std::int64_t kClockChangeS = 3600;

// Rows follow one another by days at most, where the other order makes steps of about a month.
constexpr std::int64_t kDayStepS = 86400 * 3 / 2;
constexpr std::int64_t kMonthStepS = 86400 * 20;

}  // namespace

void DateOrderFinder::Reading::add(const CalendarTime& time, std::string_view series) {
  const std::optional<LocalTime> local = time.local(order);
  if (!local) return;
  const auto found = last_s.find(series);
  if (found == last_s.end()) {
    last_s.emplace(series, local->seconds);
    return;
  }
  const std::int64_t step_s = local->seconds - found->second;
  goes_back = goes_back || step_s < -kClockChangeS;
  longest_s = std::max(longest_s, step_s);
  found->second = local->seconds;
}

void DateOrderFinder::add(const CalendarTime& time, std::string_view series) {
  if (!time.two_numbers || settled()) return;
  // As it stands the first number is kept as the month.
  if (time.month > kMonths) by_number_ = DateOrder::kDayFirst;
  if (time.day > kMonths) by_number_ = DateOrder::kMonthFirst;
  day_first_.add(time, series);
  month_first_.add(time, series);
}

DateOrder DateOrderFinder::order() const {
  if (settled()) return by_number_;
  if (day_first_.goes_back != month_first_.goes_back)
    return day_first_.goes_back ? DateOrder::kMonthFirst : DateOrder::kDayFirst;
  if (day_first_.goes_back) return DateOrder::kUnknown;
  if (day_first_.longest_s <= kDayStepS && month_first_.longest_s >= kMonthStepS)
    return DateOrder::kDayFirst;
  if (month_first_.longest_s <= kDayStepS && day_first_.longest_s >= kMonthStepS)
    return DateOrder::kMonthFirst;
  return DateOrder::kUnknown;
}

std::string DateOrderFinder::notice() const {
  const DateOrder found = order();
  if (settled() || found == DateOrder::kUnknown) return {};
  return std::string("dates are read ") +
         (found == DateOrder::kDayFirst ? "day first" : "month first") +
         ": in the other order the rows would not follow one another";
}

}  // namespace mpm::files
