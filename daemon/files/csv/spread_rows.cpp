#include "daemon/files/csv/spread_rows.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::files {
namespace {

constexpr std::int64_t kMinuteNs = 60'000'000'000;
constexpr std::size_t kFewestMinutes = 4;  // two whole ones among them

}  // namespace

std::optional<std::int64_t> rows_per_minute(const std::deque<Frame>& rows) {
  std::vector<std::int64_t> counts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].source_time_ns % kMinuteNs != 0) return std::nullopt;
    if (i > 0 && rows[i].source_time_ns == rows[i - 1].source_time_ns)
      ++counts.back();
    else
      counts.push_back(1);
  }
  if (counts.size() < kFewestMinutes) return std::nullopt;
  const auto [fewest, most] = std::minmax_element(counts.begin() + 1, counts.end() - 1);
  if (*most == 1) return std::nullopt;  // a row a minute
  return *fewest == *most && counts.front() <= *most && counts.back() <= *most ? *most : 0;
}

SpreadRows::SpreadRows(std::unique_ptr<RowSource> rows, std::deque<Frame> read,
                       std::int64_t per_minute, Fail fail)
    : rows_(std::move(rows)),
      read_(std::move(read)),
      per_minute_(per_minute),
      fail_(std::move(fail)),
      minute_ns_(read_.front().source_time_ns) {
  const auto of_first = std::count_if(read_.begin(), read_.end(), [this](const Frame& row) {
    return row.source_time_ns == minute_ns_;
  });
  at_ = per_minute_ - of_first;
}

bool SpreadRows::next(Frame& frame) {
  if (!read_.empty()) {
    frame = std::move(read_.front());
    read_.pop_front();
  } else if (!rows_->next(frame)) {
    return false;
  }
  const bool new_minute = frame.source_time_ns != minute_ns_;
  if (new_minute ? at_ != per_minute_ : at_ == per_minute_)
    fail_("the minute of " + utc_text(minute_ns_) + " has " +
          (new_minute ? counted(static_cast<std::uint64_t>(at_), "row") : "more rows") +
          ", those before it " + std::to_string(per_minute_) +
          ": its seconds are cut off, export them");
  if (new_minute) {
    minute_ns_ = frame.source_time_ns;
    at_ = 0;
  }
  frame.source_time_ns += at_++ * (kMinuteNs / per_minute_);
  return true;
}

}  // namespace mpm::files
