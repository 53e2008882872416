#include "daemon/http/system_json.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "daemon/report/record_json.hpp"

namespace mpm::http {
namespace {

/// Bytes in memory; 0 where the kernel does not say.
std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kMicrosecond = 1e-6;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + kMicrosecond * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Json unit_json_of(const UnitStore& store) {
  const std::shared_ptr<const UnitSnapshot> snapshot = store.snapshot();
  Json troubles = Json::array();
  for (const bus::Trouble& trouble : snapshot->troubles)
    troubles.push_back({{"severity", bus::to_string(trouble.severity)}, {"text", trouble.text}});
  Json health = report::json_of(snapshot->health);
  health.erase("record");
  health["unit"] = store.config().unit;
  health["troubles"] = troubles;
  health["samples_per_second"] = store.samples_per_second();
  health["page_dropped_samples"] = store.dropped();
  health["page_history_bytes"] = store.bytes();
  return health;
}

}  // namespace

Json system_json(const Board& board, const std::string& version, std::int64_t started_ns) {
  Json units = Json::array();
  for (const auto& [name, unit] : board.units()) units.push_back(unit_json_of(unit->store));
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  return {{"version", version},
          {"time_ns", now},
          {"started_ns", started_ns},
          {"resident_bytes", resident_bytes()},
          {"processor_seconds", processor_seconds()},
          {"units", units}};
}

}  // namespace mpm::http
