#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/files/times/time_zone.hpp"

namespace mpm::files {

/// Turns the time cells of a file into moments. Local times need a zone; in the hour that a clock
/// shows twice the order of the rows decides: the earlier moment, unless the row before it is past
/// that, or at it with more than half an hour between rows.
class LocalTimes {
 public:
  /// Null: local times are refused.
  explicit LocalTimes(std::shared_ptr<const TimeZone> zone = nullptr) : zone_(std::move(zone)) {}

  /// ns since 1970. Rows are in order among those with the same `series` (a tag; or "" for all).
  /// Nothing with a `problem` where the text is no time.
  [[nodiscard]] std::optional<std::int64_t> read(std::string_view text, std::string_view series,
                                                 std::string& problem);
  /// For reading the file once more.
  void restart();
  /// What was done about times that the clock shows twice; empty if there were none.
  [[nodiscard]] std::string notice() const;

 private:
  struct Series {
    std::int64_t last_ns = 0;
    std::int64_t step_ns = 0;  ///< between the last two; 0 = not known
    bool begun = false;
  };

  std::shared_ptr<const TimeZone> zone_;
  std::map<std::string, Series, std::less<>> series_;
  std::uint64_t twice_ = 0;
};

}  // namespace mpm::files
