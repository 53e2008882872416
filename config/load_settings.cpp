#include "config/load_sections.hpp"

namespace mpm::config {
namespace {

/// Where to complain about a pair of settings: at the one that is written down.
const Value& place_of(const Map& map, std::string_view first, std::string_view second) {
  const Value* value = map.find(first) != nullptr ? map.find(first) : map.find(second);
  return value != nullptr ? *value : map.place();
}

void load_materiality(const Value& section, const UnitConfig& unit, MonitorSettings& monitor) {
  std::vector<std::string> known = keys(materiality_fields());
  known.emplace_back("channels");
  const Map map = section.map(known);
  read_fields(map, materiality_fields(), monitor.materiality);
  const Value* channels = map.find("channels");
  if (channels == nullptr || channels->is_null()) return;
  known = keys(materiality_fields());
  known.insert(known.end(), {"cv", "mv"});
  for (const Value& item : channels->items()) {
    const Map entry = item.map(known);
    ChannelMateriality channel{-1, -1, monitor.materiality};
    read_fields(entry, materiality_fields(), channel.limits);
    if (const Value* cv = entry.require("cv")) channel.cv = find_tag(*cv, unit.cv_tags(), "cv");
    if (const Value* mv = entry.require("mv"))
      channel.input = find_tag(*mv, unit.input_tags(), "mv or dv");
    if (channel.cv >= 0 && channel.input >= 0) monitor.channel_materiality.push_back(channel);
  }
}

// Whoever calls an operator must say what for (ISA-18.2, rationalization).
void load_controller_alarm(const Value& section, ControllerAlarmSettings& alarm) {
  if (section.is_null()) return;
  const Map map = section.map(keys(controller_alarm_fields()));
  read_fields(map, controller_alarm_fields(), alarm);
  if (alarm.notification_class != NotificationClass::kAlarm) return;
  std::vector<std::string> missing;
  if (alarm.consequence.empty()) missing.emplace_back("consequence");
  if (alarm.action.empty()) missing.emplace_back("action");
  if (!(alarm.time_to_respond_s > 0.0)) missing.emplace_back("time_to_respond");
  if (!missing.empty())
    map.find("class")->error("an alarm needs an operator's answer in time: give " + join(missing) +
                             ", or leave it an alert");
}

}  // namespace

void load_monitor(const Value* section, const UnitConfig& unit, MonitorSettings& monitor) {
  if (section == nullptr) return;
  std::vector<std::string> known = keys(monitor_fields());
  known.emplace_back("materiality");
  const Map map = section->map(known);
  read_fields(map, monitor_fields(), monitor);
  if (const Value* materiality = map.find("materiality"))
    load_materiality(*materiality, unit, monitor);
  if (monitor.first_lag > monitor.last_lag)
    place_of(map, "first_lag", "last_lag").error("first_lag must not be above last_lag");
  if (of_ranks(monitor.correlation) && monitor.threshold == ThresholdKind::kMeanLine)
    place_of(map, "threshold", "correlation")
        .error("mean_line is no threshold of rank correlations");
  if (map.find("memory") != nullptr && monitor.memory_s > 0.0 &&
      monitor.memory_s <= unit.sample_time_s)
    map.find("memory")->error("must be longer than the sample time");
}

void load_alarms(const Value* section, UnitConfig& config) {
  if (section == nullptr) return;
  std::vector<std::string> known = keys(alarm_fields());
  for (const std::string& key : keys(managed_alarm_fields())) known.push_back(key);
  known.emplace_back("controller");
  const Map map = section->map(known);
  read_fields(map, alarm_fields(), config.alarms);
  read_fields(map, managed_alarm_fields(), config.alarm_handling.managed);
  if (const Value* controller = map.find("controller"))
    load_controller_alarm(*controller, config.alarm_handling.controller);
  if (config.alarms.clear_p_value < config.alarms.raise_p_value)
    place_of(map, "clear_p_value", "raise_p_value")
        .error("clear_p_value must not be below raise_p_value");
}

void load_dds(const Value* section, UnitConfig& config) {
  if (section == nullptr) return;
  std::vector<std::string> known = keys(bus_fields());
  known.emplace_back("peers");
  const Map map = section->map(known);
  read_fields(map, bus_fields(), config.dds);
  if (const Value* security = map.find("security");
      security != nullptr && !config.dds.security.empty()) {
    config.dds.security_at = security->where();
    if (config.dds.security.front() != '/')
      security->error("must be an absolute path: programs start in different folders");
  }
  if (const Value* peers = map.find("peers")) {
    if (peers->is_null()) return;
    config.dds.peers.clear();
    for (const Value& item : peers->items())
      if (const std::optional<std::string> peer = item.text()) config.dds.peers.push_back(*peer);
  }
}

}  // namespace mpm::config
