#include "core/alarm/alarm_load.hpp"

#include <algorithm>
#include <deque>
#include <optional>

#include "core/alarm/calibration.hpp"

namespace mpm {
namespace {

using namespace calibration::load;

/// What has come within the last `width` of time.
class Window {
 public:
  explicit Window(std::int64_t width) : width_(width) {}
  std::size_t add(std::int64_t time) {
    forget(time);
    times_.push_back(time);
    return times_.size();
  }
  /// Up to and without `time - width`.
  void forget(std::int64_t time) {
    while (!times_.empty() && times_.front() <= time - width_) times_.pop_front();
  }
  [[nodiscard]] std::size_t size() const { return times_.size(); }
  /// When one more will have left.
  [[nodiscard]] std::int64_t next_leaves() const { return times_.front() + width_; }

 private:
  std::int64_t width_;
  std::deque<std::int64_t> times_;
};

/// Counts floods, and how long they last.
class Floods {
 public:
  void add(std::int64_t time) {
    settle(time);
    window_.add(time);
    if (!since_ && window_.size() >= kFloodBegins) {
      since_ = time;
      ++count_;
    }
  }
  /// A flood ends when so many have left the window that few are in it.
  void settle(std::int64_t time) {
    while (window_.size() > 0 && window_.next_leaves() <= time) {
      const std::int64_t leaves = window_.next_leaves();
      window_.forget(leaves);
      if (since_ && window_.size() <= kFloodEnds) {
        lasted_ += leaves - *since_;
        since_.reset();
      }
    }
  }
  void end(std::int64_t time) {
    settle(time);
    if (since_) lasted_ += time - *since_;
    since_.reset();
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t lasted() const { return lasted_; }

 private:
  Window window_{kWindow};
  std::optional<std::int64_t> since_;
  std::uint64_t count_ = 0;
  std::int64_t lasted_ = 0;
};

struct OneAlarm {
  Window minute{kChatterWindow};
  std::optional<std::int64_t> since;
  bool chatters = false, stale = false;
};

}  // namespace

AlarmLoad alarm_load(const std::vector<AlarmLoadEvent>& events, int alarms, std::int64_t from_ns,
                     std::int64_t until_ns) {
  AlarmLoad load;
  load.by_alarm.assign(static_cast<std::size_t>(alarms), 0);
  std::vector<OneAlarm> each(static_cast<std::size_t>(alarms));
  Window window(kWindow);
  Floods floods;
  for (const AlarmLoadEvent& event : events) {
    OneAlarm& alarm = each[static_cast<std::size_t>(event.alarm)];
    if (event.kind == AlarmLoadEvent::Kind::kEnded) {
      alarm.stale = alarm.stale || (alarm.since && event.time_ns - *alarm.since > kStale);
      alarm.since.reset();
      continue;
    }
    ++load.annunciated;
    ++load.by_priority[static_cast<std::size_t>(event.priority)];
    ++load.by_alarm[static_cast<std::size_t>(event.alarm)];
    load.most_in_10_min = std::max<std::uint64_t>(load.most_in_10_min, window.add(event.time_ns));
    floods.add(event.time_ns);
    alarm.chatters = alarm.minute.add(event.time_ns) >= kChatter || alarm.chatters;
    if (!alarm.since) alarm.since = event.time_ns;
  }
  floods.end(until_ns);
  for (const OneAlarm& alarm : each) {
    load.chattering += alarm.chatters ? 1 : 0;
    load.stale += alarm.stale || (alarm.since && until_ns - *alarm.since > kStale) ? 1 : 0;
  }
  load.floods = floods.count();
  const auto span = static_cast<double>(until_ns - from_ns);
  if (span > 0.0) {
    load.days = span / static_cast<double>(kDay);
    load.per_day = static_cast<double>(load.annunciated) / load.days;
    load.time_in_flood = static_cast<double>(floods.lasted()) / span;
  }
  return load;
}

}  // namespace mpm
