#include "daemon/files/times/date_order.hpp"

#include <algorithm>
#include <optional>

namespace mpm::files {
namespace {

// Clocks that are set to winter time go back so far.
constexpr std::int64_t kClockChangeS = 3600;

// Rows follow one another by days at most, where another order makes steps of about a month; by
// less than those where it makes steps of a year.
constexpr std::int64_t kDayStepS = 86400 * 3 / 2;
constexpr std::int64_t kMonthStepS = 86400 * 20;
constexpr std::int64_t kYearStepS = 86400 * 300;

}  // namespace

void DateOrderFinder::Reading::add(const CalendarTime& time, std::string_view series) {
  const std::optional<LocalTime> local = time.local(order);
  possible = possible && local;
  if (!possible) return;
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
  const auto may_be = [&time](const Reading& reading) {
    return reading.possible && time.local(reading.order);
  };
  if (std::none_of(readings_.begin(), readings_.end(), may_be)) return;  // it is no date
  any_ = true;
  for (Reading& reading : readings_)
    if (reading.possible) reading.add(time, series);
}

bool DateOrderFinder::settled() const {
  return any_ && std::ranges::count_if(readings_, &Reading::possible) == 1;
}

std::vector<const DateOrderFinder::Reading*> DateOrderFinder::possible() const {
  std::vector<const Reading*> found;
  for (const Reading& reading : readings_)
    if (any_ && reading.possible) found.push_back(&reading);
  return found;
}

DateOrder DateOrderFinder::order_of_rows() const {
  std::vector<const Reading*> left = possible();
  std::erase_if(left, [](const Reading* reading) { return reading->goes_back; });
  if (left.size() == 1) return left.front()->order;
  std::sort(left.begin(), left.end(), [](const Reading* one, const Reading* other) {
    return one->longest_s < other->longest_s;
  });
  const auto follow = [&left](std::int64_t most_s, std::int64_t others_s) {
    return left.size() > 1 && left[0]->longest_s <= most_s && left[1]->longest_s >= others_s;
  };
  return follow(kDayStepS, kMonthStepS) || follow(kMonthStepS, kYearStepS) ? left.front()->order
                                                                           : DateOrder::kUnknown;
}

DateOrder DateOrderFinder::order() const {
  std::vector<const Reading*> left = possible();
  if (left.size() == 1) return left.front()->order;
  const DateOrder by_rows = order_of_rows();
  std::erase_if(left, [](const Reading* each) { return each->order == DateOrder::kYearFirst; });
  return by_rows == DateOrder::kUnknown && left.size() == 1 ? left.front()->order : by_rows;
}

std::string DateOrderFinder::notice() const {
  const DateOrder found = order();
  if (settled() || found == DateOrder::kUnknown) return {};
  const std::string read = "dates are read " + std::string(name_of(found)) + " first";
  if (order_of_rows() == DateOrder::kUnknown)
    return read +
           ": two digits at the end are taken for the year; if they are the day, say how it "
           "is written with --time-format";
  return read + ": in another order the rows would not follow one another";
}

}  // namespace mpm::files
