#include "daemon/files/csv/csv_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "config/finding.hpp"
#include "core/signal/nanoseconds.hpp"
#include "daemon/files/csv/averaged_rows.hpp"
#include "daemon/files/csv/held_rows.hpp"
#include "daemon/files/csv/prepared_rows.hpp"
#include "daemon/files/csv/spread_rows.hpp"

namespace mpm::files {
namespace {

constexpr std::size_t kRowsAhead = 200;
constexpr double kSampleTimeTolerance = 0.1;
constexpr double kIntervalsAhead = 100.0, kMostRowsAhead = 20'000.0;  // to see MVs move
constexpr double kSparsest = 0.5;          // of the sample time: two rows make a mean
constexpr double kHeldPerInterval = 10.0;  // rows
constexpr std::int64_t kNsPerMinute = 60'000'000'000;
constexpr double kLargestInterval = 9e15;  // exact in a double

// A clock was set back by more intervals than these if that many rows in a row say so.
constexpr double kClockStep = 10.0;
constexpr std::size_t kRowsToBelieve = 3;

// Part of a time stamp's deviation that is taken for the clock's own drift.
constexpr double kFollow = 0.02;

std::string seconds(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

}  // namespace

CsvReader::CsvReader(const std::string& path, const config::UnitConfig& unit,
                     const TimeStyle& times, Purpose purpose)
    : CsvReader(open_regular_file(path), path, unit, times, purpose) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown) file_bytes_ = size;
}

CsvReader::CsvReader(std::unique_ptr<std::istream> input, const std::string& name,
                     const config::UnitConfig& unit, const TimeStyle& times, Purpose purpose)
    : sample_time_s_(unit.sample_time_s),
      purpose_(purpose),
      lines_(std::move(input), name),
      tags_(unit, purpose) {
  open(unit, times);
}

void CsvReader::open(const config::UnitConfig& unit, const TimeStyle& times) {
  const SignalCounts counts = unit.counts();
  lines_.join_quoted();
  std::vector<Cell> header;
  const CsvFormat format = find_format(lines_, times, sample_time_s_, &tags_, header, row_notices_);
  const int header_line = lines_.number();
  rows_ = read_rows(lines_, format, header, tags_, counts, row_notices_);
  if (rows_->has_own_times()) hold(counts);
  rows_ = std::make_unique<PreparedRows>(std::move(rows_), unit, purpose_);
  const std::vector<std::string> told = tags_.notices();
  notices_.insert(notices_.begin(), told.begin(), told.end());

  look_ahead();
  if (ahead_.empty()) lines_.fail(header_line, 1, "no data below the header");
  spread_minutes(header_line);
  first_ns_ = ahead_.front().source_time_ns;
  fit_sample_time(header_line);
}

void CsvReader::look_ahead() {
  Frame frame;
  while (ahead_.size() < kRowsAhead && rows_->next(frame)) ahead_.push_back(std::move(frame));
}

void CsvReader::spread_minutes(int header_line) {
  const std::optional<std::int64_t> per_minute = rows_per_minute(ahead_);
  if (!per_minute) return;
  const bool uneven = *per_minute == 0 || kNsPerMinute % *per_minute != 0;
  if (uneven && sample_time_s_ * kNsPerSecond >= static_cast<double>(kNsPerMinute)) return;
  const auto fail = [this, header_line](const std::string& message) {
    lines_.fail(header_line, 1, message);
  };
  if (uneven)
    fail(
        "several rows have the same minute for their time, and not each minute equally many: the "
        "seconds are cut off, export them");
  rows_ =
      std::make_unique<SpreadRows>(std::move(rows_), std::exchange(ahead_, {}), *per_minute, fail);
  look_ahead();
  notices_.push_back("the seconds of the times are cut off: the " + std::to_string(*per_minute) +
                     " rows of each minute are spread evenly over it");
}

// To judge a unit finely enough for the moments at which MVs move; a recording has one row for each
// interval.
void CsvReader::hold(const SignalCounts& counts) {
  const double step_s =
      purpose_ == Purpose::kJudge ? sample_time_s_ / kHeldPerInterval : sample_time_s_;
  auto held = std::make_unique<HeldRows>(std::move(rows_), counts, step_s, sample_time_s_);
  notices_.emplace_back(held->notice());
  rows_ = std::move(held);
}

void CsvReader::fit_sample_time(int first_line) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < ahead_.size(); ++i) {
    const auto step_ns =
        static_cast<double>(ahead_[i].source_time_ns - ahead_[i - 1].source_time_ns);
    if (step_ns > 0.0) steps_s.push_back(step_ns / kNsPerSecond);
  }
  if (steps_s.empty() && ahead_.size() > 2 &&
      ahead_.back().source_time_ns < ahead_.front().source_time_ns)
    lines_.fail(first_line, 1,
                "the rows go back in time: export or sort them with the oldest first");
  if (steps_s.empty()) return;
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  if (purpose_ == Purpose::kJudge &&
      *middle <= (kSparsest + kSampleTimeTolerance) * sample_time_s_) {
    average(*middle);
    return;
  }
  if (std::abs(*middle - sample_time_s_) > kSampleTimeTolerance * sample_time_s_)
    lines_.fail(first_line, 1,
                "the rows are " + seconds(*middle) + " apart (median), the unit's sample_time is " +
                    seconds(sample_time_s_));
}

void CsvReader::average(double step_s) {
  const auto enough =
      static_cast<std::size_t>(std::min(kMostRowsAhead, kIntervalsAhead * sample_time_s_ / step_s));
  for (Frame frame; ahead_.size() < enough && rows_->next(frame);) ahead_.push_back(frame);
  const std::optional<std::int64_t> moves_ns = moves_at(ahead_, step_s, sample_time_s_);
  rows_ = std::make_unique<AveragedRows>(std::move(rows_), std::exchange(ahead_, {}),
                                         moves_ns.value_or(first_ns_), step_s, sample_time_s_,
                                         row_notices_);
  notices_.push_back(
      "the rows, " + seconds(step_s) + " apart, are averaged to the unit's sample_time of " +
      seconds(sample_time_s_) + (moves_ns ? ", in intervals that begin where the MVs move" : ""));
  Frame frame;
  if (!rows_->next(frame)) return;
  first_ns_ = frame.source_time_ns;
  ahead_.push_back(std::move(frame));
}

bool CsvReader::read(Frame& frame) {
  if (ahead_.empty()) return rows_->next(frame);
  frame = std::move(ahead_.front());
  ahead_.pop_front();
  return true;
}

bool CsvReader::next(Frame& frame) {
  if (!read(frame)) {
    if (std::optional<std::string> notice = lines_.take_notice())
      notices_.push_back(std::move(*notice));
    notices_.insert(notices_.end(), row_notices_.begin(), row_notices_.end());
    row_notices_.clear();
    return false;
  }
  number(frame);
  return true;
}

double CsvReader::share_read() const {
  if (file_bytes_ == 0) return 0.0;
  return static_cast<double>(lines_.bytes_read()) / static_cast<double>(file_bytes_);
}

double CsvReader::elapsed(const Frame& frame) const {
  const auto elapsed_ns = static_cast<double>(frame.source_time_ns - first_ns_);
  return elapsed_ns / (sample_time_s_ * kNsPerSecond) - phase_;
}

// Time stamps that jitter round to their interval; a clock that runs a little fast or slow is
// followed; one that was set back goes on counting after a gap. A clock set forward looks like a
// gap.
void CsvReader::number(Frame& frame) {
  double at = elapsed(frame);
  if (at < static_cast<double>(last_) - kClockStep && clock_stays_back(at)) {
    notices_.push_back("the clock went back by " +
                       seconds((static_cast<double>(last_) - at) * sample_time_s_) +
                       "; the rows after it are taken as they follow");
    phase_ += at - static_cast<double>(last_ + 2);
    at = static_cast<double>(last_ + 2);
  }
  frame.interval = std::llround(std::clamp(at, -kLargestInterval, kLargestInterval));
  if (frame.interval != last_ + 1) {
    last_ = std::max(last_, frame.interval);
    return;
  }
  last_ = frame.interval;
  phase_ += kFollow * (at - static_cast<double>(frame.interval));
}

// The next rows go on from there rather than from the last interval.
bool CsvReader::clock_stays_back(double at) {
  while (ahead_.size() < kRowsToBelieve) {
    Frame frame;
    if (!rows_->next(frame)) return false;
    ahead_.push_back(std::move(frame));
  }
  double before = at;
  for (std::size_t i = 0; i < kRowsToBelieve; ++i) {
    const double next = elapsed(ahead_[i]);
    if (next <= before || next >= static_cast<double>(last_) - kClockStep) return false;
    before = next;
  }
  return true;
}

}  // namespace mpm::files
