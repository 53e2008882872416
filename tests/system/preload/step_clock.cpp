// Loaded before a program (LD_PRELOAD): the machine's clock, which it then sees set by
// MPM_STEP_MS forward and back again, each time after MPM_STEP_EVERY readings. The steady clock and
// everybody else's stay as they are.

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

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const auto result = static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  if (result != 0 || clock != CLOCK_REALTIME) return result;
  static const long long step_ns = number_of("MPM_STEP_MS") * kNsPerMs;
  static const long long every = number_of("MPM_STEP_EVERY");
  static std::atomic<long long> readings{0};
  if (every <= 0 || readings++ / every % 2 == 0) return result;
  const long long now_ns = time->tv_sec * kNsPerSecond + time->tv_nsec + step_ns;
  time->tv_sec = now_ns / kNsPerSecond;
  time->tv_nsec = now_ns % kNsPerSecond;
  return result;
}
