#include "daemon/live/diagnosis_schedule.hpp"

#include <algorithm>

#include "core/archive/archive.hpp"
#include "core/signal/saturated.hpp"

namespace mpm::live {
namespace {

// Fewer tell nothing about a gain.
constexpr std::int64_t kFewestUnseen = 100;

}  // namespace

bool DiagnosisSchedule::due(std::int64_t time_ns, int rows, bool raised, bool active) {
  if (raised) {
    waiting_ = true;
    since_alarm_ = 0;
    next_at_ = settings_.settling_rows;
  } else {
    ++since_alarm_;
  }
  if (!active) waiting_ = false;
  if (!waiting_ || since_alarm_ < next_at_ || rows < settings_.needed_rows) return false;
  if (last_start_ns_) {
    // A clock that was set back begins the period anew.
    last_start_ns_ = std::min(*last_start_ns_, time_ns);
    if (saturated_difference(time_ns, *last_start_ns_) < settings_.period_ns) return false;
  }
  last_start_ns_ = time_ns;
  next_at_ = since_alarm_ + std::clamp<std::int64_t>(since_alarm_, 1, settings_.renewed_rows);
  return true;
}

void DiagnosisSchedule::archive(Archive& a) {
  // not archived: settings_ (construction)
  a(waiting_, since_alarm_, next_at_);
  bool started = last_start_ns_.has_value();
  a(started);
  if (a.reads()) last_start_ns_ = started ? std::optional<std::int64_t>(0) : std::nullopt;
  if (last_start_ns_) a.time(*last_start_ns_);
}

int unseen_rows(int rows, std::int64_t rows_since_alarm) {
  return static_cast<int>(
      std::min<std::int64_t>(rows / 3, std::max(kFewestUnseen, rows_since_alarm / 2)));
}

}  // namespace mpm::live
