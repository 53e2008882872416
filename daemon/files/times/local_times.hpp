#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/files/times/calendar_time.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::files {

/// Turns the time cells of a file into moments. Local times need a zone; in the hour that a clock
/// shows twice the order of the rows decides: the earlier moment, unless the row before it is past
/// that, or at it with more than half an hour between rows.
class LocalTimes {
 public:
  /// Without a zone in `style` local times are refused, and without `order` dates that may be read
  /// either way.
  explicit LocalTimes(TimeStyle style = {}, DateOrder order = DateOrder::kUnknown)
      : style_(std::move(style)), order_(order) {}

  /// ns since 1970. Rows are in order among those with the same `series` (a tag; or "" for all).
  /// Nothing with a `problem` where the text is no time.
  [[nodiscard]] std::optional<std::int64_t> read(std::string_view text, std::string_view series,
                                                 std::string& problem);
  /// For reading the file once more.
  void restart();
  /// What was assumed: the zone, the unit of numbers, what was done about times that the clock
  /// shows twice.
  [[nodiscard]] std::vector<std::string> notices() const;

 private:
  struct Series {
    std::int64_t last_ns = 0;
    std::int64_t step_ns = 0;  ///< between the last two; 0 = not known
    bool begun = false;
  };

  [[nodiscard]] std::optional<std::int64_t> read_number(std::string_view text,
                                                        std::string& problem);
  [[nodiscard]] std::optional<std::int64_t> read_local(const LocalTime& local,
                                                       std::string_view series,
                                                       std::string& problem);

  TimeStyle style_;
  DateOrder order_;
  std::map<std::string, Series, std::less<>> series_;
  std::uint64_t local_ = 0, twice_ = 0;
  const char* unit_ = nullptr;  ///< of numbers, where it is not seconds
  bool dates_ = false;          ///< a date came
};

}  // namespace mpm::files
