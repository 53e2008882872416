#include "config/load_sections.hpp"

namespace mpm::config {
namespace {

/// Where to complain about a pair of settings: at the one that is written down.
const Value& place_of(const Map& map, std::string_view first, std::string_view second) {
  const Value* value = map.find(first) != nullptr ? map.find(first) : map.find(second);
  return value != nullptr ? *value : map.place();
}

}  // namespace

void load_monitor(const Value* section, double sample_time_s, MonitorSettings& monitor) {
  if (section == nullptr) return;
  const Map map = section->map(keys(monitor_fields()));
  read_fields(map, monitor_fields(), monitor);
  if (monitor.first_lag > monitor.last_lag)
    place_of(map, "first_lag", "last_lag").error("first_lag must not be above last_lag");
  if (map.find("memory") != nullptr && monitor.memory_s > 0.0 && monitor.memory_s <= sample_time_s)
    map.find("memory")->error("must be longer than the sample time");
}

void load_alarms(const Value* section, UnitConfig& config) {
  if (section == nullptr) return;
  const Map map = section->map(keys(alarm_fields()));
  read_fields(map, alarm_fields(), config.alarms);
  if (config.alarms.clear_p_value < config.alarms.raise_p_value)
    place_of(map, "clear_p_value", "raise_p_value")
        .error("clear_p_value must not be below raise_p_value");
}

void load_dds(const Value* section, UnitConfig& config) {
  if (section == nullptr) return;
  std::vector<std::string> known = keys(dds_fields());
  known.emplace_back("peers");
  const Map map = section->map(known);
  read_fields(map, dds_fields(), config.dds);
  if (const Value* peers = map.find("peers")) {
    if (peers->is_null()) return;
    config.dds.peers.clear();
    for (const Value& item : peers->items())
      if (const std::optional<std::string> peer = item.text()) config.dds.peers.push_back(*peer);
  }
}

}  // namespace mpm::config
