#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {

/// How many rows each minute has, where all times are whole minutes and several rows have the same:
/// 0 where the minutes differ, nothing where times are not so. The first minute may lack its first
/// rows and the last one its last.
[[nodiscard]] std::optional<std::int64_t> rows_per_minute(const std::deque<Frame>& rows);

/// Rows whose seconds were cut off, spread evenly over their minute.
class SpreadRows : public RowSource {
 public:
  using Fail = std::function<void(const std::string& message)>;

  /// `read` are the first rows of `rows`; `per_minute` divides a minute. `fail` throws where a
  /// minute has another number of rows.
  SpreadRows(std::unique_ptr<RowSource> rows, std::deque<Frame> read, std::int64_t per_minute,
             Fail fail);

  [[nodiscard]] bool next(Frame& frame) override;

 private:
  std::unique_ptr<RowSource> rows_;
  std::deque<Frame> read_;
  std::int64_t per_minute_;
  Fail fail_;
  std::int64_t minute_ns_ = 0;
  std::int64_t at_ = 0;  ///< rows of the minute that are over
};

}  // namespace mpm::files
