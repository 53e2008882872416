#include "idl/log.hpp"

#include <dds/ddsrt/log.h>

#include <chrono>
#include <string_view>

#include "core/parallel/mutex.hpp"

namespace mpm::idl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kLinesPerPeriod = 10;
constexpr std::chrono::seconds kPeriod{10};

struct LogState {
  Mutex mutex;
  LogHandler handler MPM_GUARDED_BY(mutex);
  std::string last_line MPM_GUARDED_BY(mutex);
  Clock::time_point period_end MPM_GUARDED_BY(mutex);
  int lines MPM_GUARDED_BY(mutex) = 0;       // passed in this period
  int suppressed MPM_GUARDED_BY(mutex) = 0;  // not passed in this period
};

LogState& log_state() {
  // Never destroyed: Cyclone's threads may log until the process is gone.
  static LogState& state = *new LogState;
  return state;
}

LogLevel level_of(std::uint32_t priority) {
  if (priority & (DDS_LC_FATAL | DDS_LC_ERROR)) return LogLevel::kError;
  return priority & DDS_LC_WARNING ? LogLevel::kWarning : LogLevel::kInfo;
}

void start_new_period(LogState& state, Clock::time_point now) MPM_REQUIRES(state.mutex) {
  if (state.suppressed > 0 && state.handler)
    state.handler(LogLevel::kWarning,
                  std::to_string(state.suppressed) + " more DDS messages not shown");
  state.period_end = now + kPeriod;
  state.lines = 0;
  state.suppressed = 0;
}

void on_log(void*, const dds_log_data_t* data) {
  std::string_view line(data->message, data->size);
  while (!line.empty() && line.back() == '\n') line.remove_suffix(1);

  LogState& state = log_state();
  const MutexLock lock(state.mutex);
  state.last_line = line;
  const Clock::time_point now = Clock::now();
  if (now >= state.period_end) start_new_period(state, now);
  if (state.lines >= kLinesPerPeriod) {
    ++state.suppressed;
    return;
  }
  ++state.lines;
  if (state.handler) state.handler(level_of(data->priority), state.last_line);
}

}  // namespace

void set_log_handler(LogHandler handler) {
  {
    LogState& state = log_state();
    const MutexLock lock(state.mutex);
    state.handler = std::move(handler);
  }
  dds_set_log_sink(&on_log, nullptr);
}

std::string last_log_line() {
  LogState& state = log_state();
  const MutexLock lock(state.mutex);
  return state.last_line;
}

}  // namespace mpm::idl
