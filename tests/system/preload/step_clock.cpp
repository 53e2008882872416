// Loaded before a program (LD_PRELOAD): the machine's clock, which it then sees set by
// MPM_STEP_MS forward and back again, each time after MPM_STEP_EVERY readings, or from the start
// where that is 0. The steady clock and everybody else's stay as they are, and so does how long the
// program's waits last, unless MPM_STEP_WAITS is 1: then each goes on as if the clock were set back
// during it.

#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>

namespace {

constexpr long long kNsPerMs = 1'000'000;
constexpr long long kNsPerSecond = 1'000'000'000;

long long number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoll(text);
}

long long step_ns() {
  static const long long step = number_of("MPM_STEP_MS") * kNsPerMs;
  return step;
}

long long ns_of(const timespec& time) { return time.tv_sec * kNsPerSecond + time.tv_nsec; }

void set(timespec& time, long long ns) {
  time.tv_sec = ns / kNsPerSecond;
  time.tv_nsec = ns % kNsPerSecond;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (result != 0 || clock != CLOCK_REALTIME) return result;
  static const long long every = number_of("MPM_STEP_EVERY");
  static std::atomic<long long> readings{0};
  if (every == 0 || readings++ / every % 2 == 1) set(*time, ns_of(*time) + step_ns());
  return result;
}

// The kernel does not know of the step, so an end that was reckoned from a stepped clock would be
// that far away.
extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* end) {
  timespec now{};
  static_cast<void>(syscall(SYS_clock_gettime, CLOCK_REALTIME, &now));
  const long long left_ns = ns_of(*end) - ns_of(now);
  timespec true_end = *end;
  static const bool waits_too = number_of("MPM_STEP_WAITS") == 1;
  if (!waits_too && std::llabs(left_ns - step_ns()) < std::llabs(left_ns))
    set(true_end, ns_of(*end) - step_ns());
  return pthread_cond_clockwait(condition, mutex, CLOCK_REALTIME, &true_end);
}
