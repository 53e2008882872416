#pragma once

#include <deque>
#include <memory>
#include <string>

#include "core/parallel/mutex.hpp"
#include "core/record/alarm_record.hpp"
#include "daemon/http/event_source.hpp"

namespace mpm::http {

/// The last alarm events since the start, in memory.
class RecentEvents : public EventSource {
 public:
  /// Half a megabyte or two; a month of a plant that is well kept.
  static constexpr std::size_t kKept = 5000;

  explicit RecentEvents(std::size_t kept = kKept) : kept_(kept) {}

  /// `text`: what is wrong, in words, as of then.
  void add(const AlarmRecord& alarm, std::string text);
  [[nodiscard]] std::vector<nlohmann::ordered_json> query(const EventQuery& query) const override;

 private:
  struct Event {
    AlarmRecord alarm;
    std::string text;
  };

  std::size_t kept_;
  mutable Mutex mutex_;
  std::deque<std::shared_ptr<const Event>> events_ MPM_GUARDED_BY(mutex_);
};

}  // namespace mpm::http
