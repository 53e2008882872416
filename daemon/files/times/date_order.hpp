#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "daemon/files/times/calendar_time.hpp"

namespace mpm::files {

/// Finds which of the two numbers of 03/04/2026 is the day, from all the dates of a file: one that
/// is larger than 12 tells it; else only one order may let time go on without going back; else only
/// one may let the days follow one another, where the other jumps from month to month.
class DateOrderFinder {
 public:
  /// In the order of the rows among those with the same `series` (a tag; or "" for all).
  void add(const CalendarTime& time, std::string_view series);

  /// Whether further dates can change nothing.
  [[nodiscard]] bool settled() const { return by_number_ != DateOrder::kUnknown; }
  [[nodiscard]] DateOrder order() const;
  /// For a person: what told it; empty where a number did.
  [[nodiscard]] std::string notice() const;

 private:
  /// What would be if the dates had one of the orders.
  struct Reading {
    DateOrder order;
    std::map<std::string, std::int64_t, std::less<>> last_s;  ///< of each series
    std::int64_t longest_s = 0;                               ///< step
    bool goes_back = false;

    void add(const CalendarTime& time, std::string_view series);
  };

  Reading day_first_{DateOrder::kDayFirst, {}, 0, false};
  Reading month_first_{DateOrder::kMonthFirst, {}, 0, false};
  DateOrder by_number_ = DateOrder::kUnknown;
};

}  // namespace mpm::files
