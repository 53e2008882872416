#include "daemon/http/process_load.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace mpm::http {

ProcessLoad process_load() {
  ProcessLoad load;
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  load.resident_bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kMicrosecond = 1e-6;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + kMicrosecond * static_cast<double>(time.tv_usec);
  };
  load.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  return load;
}

}  // namespace mpm::http
