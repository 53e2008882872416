#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/files/times/calendar_time.hpp"

namespace mpm::files {

/// Finds which of the numbers of 03/04/2026 or 26/03/04 is the day, from all the dates of a file: a
/// number that none but one order has in its calendar tells it (13 is no month); else only one
/// order may let time go on without going back; else only one may let the days follow one another,
/// where the others jump from month to month, or the weeks, where they jump from year to year.
/// Where all that speaks against a year at the end is that it might come first, it is taken to be
/// at the end, and that is told.
class DateOrderFinder {
 public:
  /// In the order of the rows among those with the same `series` (a tag; or "" for all).
  void add(const CalendarTime& time, std::string_view series);

  /// Whether further dates can change nothing.
  [[nodiscard]] bool settled() const;
  [[nodiscard]] DateOrder order() const;
  /// For a person: what told it; empty where a number did.
  [[nodiscard]] std::string notice() const;

 private:
  /// What would be if the dates had one of the orders.
  struct Reading {
    DateOrder order;
    std::map<std::string, std::int64_t, std::less<>> last_s = {};  ///< of each series
    std::int64_t longest_s = 0;                                    ///< step
    bool goes_back = false;
    bool possible = true;  ///< all dates are in the calendar

    void add(const CalendarTime& time, std::string_view series);
  };

  [[nodiscard]] std::vector<const Reading*> possible() const;
  [[nodiscard]] DateOrder order_of_rows() const;

  std::array<Reading, 3> readings_ = {Reading{DateOrder::kDayFirst},
                                      Reading{DateOrder::kMonthFirst},
                                      Reading{DateOrder::kYearFirst}};
  bool any_ = false;
};

}  // namespace mpm::files
