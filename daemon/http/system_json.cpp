#include "daemon/http/system_json.hpp"

#include <chrono>

#include "daemon/http/process_load.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::http {
namespace {

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
  const ProcessLoad load = process_load();
  return {{"version", version},
          {"time_ns", now},
          {"started_ns", started_ns},
          {"resident_bytes", load.resident_bytes},
          {"processor_seconds", load.processor_seconds},
          {"units", units}};
}

}  // namespace mpm::http
