#include "daemon/report/detect_report.hpp"

#include <algorithm>
#include <set>

#include "config/unit_layout.hpp"
#include "daemon/report/record_json.hpp"
#include "daemon/report/unit_performance.hpp"

namespace mpm::report {
namespace {

double seconds(std::int64_t time_ns) { return static_cast<double>(time_ns) / 1e9; }

}  // namespace

bool all_match(const std::vector<ChannelRecord>& channels) {
  const auto are = [&](Verdict verdict) {
    return std::any_of(channels.begin(), channels.end(),
                       [=](const ChannelRecord& channel) { return channel.verdict == verdict; });
  };
  return are(Verdict::kMatch) && !are(Verdict::kMismatch);
}

int mismatching_cvs(const std::vector<ChannelRecord>& channels) {
  std::set<std::string> cvs;
  for (const ChannelRecord& channel : channels)
    if (channel.verdict == Verdict::kMismatch || channel.alarm == AlarmState::kActive)
      cvs.insert(channel.cv);
  return static_cast<int>(cvs.size());
}

bool DetectReport::mismatch() const {
  return std::any_of(channels.begin(), channels.end(), [](const ChannelRecord& channel) {
    return channel.verdict == Verdict::kMismatch;
  });
}

void DetectReport::take_counters(const Monitor& monitor, const config::UnitConfig& config) {
  const MonitorCounters& counters = monitor.counters();
  samples = counters.frames;
  used_samples = counters.used;
  missing = counters.missing;
  out_of_order = counters.out_of_order;
  bad_values = counters.bad_values;
  frozen = counters.implausible.frozen;
  clipped = counters.implausible.clipped;
  spikes = counters.implausible.spikes;
  bad_tags = config::by_tag(config, counters.bad_of);
  for (std::size_t cv = 0; cv < config.cv.size(); ++cv) {
    samples_needed[config.cv[cv].tag] = monitor.samples_needed(static_cast<int>(cv));
    const double every = monitor.read_every(static_cast<int>(cv));
    if (every > 0.0) read_every[config.cv[cv].tag] = every;
    if (monitor.corrected(static_cast<int>(cv)))
      corrected_predictions.push_back(config.cv[cv].prediction);
    if (monitor.of_other_model(static_cast<int>(cv)))
      other_predictions.push_back(config.cv[cv].prediction);
  }
}

nlohmann::ordered_json to_json(const DetectReport& report) {
  nlohmann::ordered_json json{{"unit", report.unit},
                              {"samples", report.samples},
                              {"used_samples", report.used_samples},
                              {"missing_samples", report.missing},
                              {"out_of_order_samples", report.out_of_order},
                              {"bad_values", report.bad_values},
                              {"frozen_values", report.frozen},
                              {"clipped_values", report.clipped},
                              {"spikes", report.spikes},
                              {"channels", nlohmann::ordered_json::array()},
                              {"alarms", nlohmann::ordered_json::array()}};
  if (!report.corrected_predictions.empty())
    json["corrected_predictions"] = report.corrected_predictions;
  if (!report.other_predictions.empty()) json["other_predictions"] = report.other_predictions;
  for (const auto& [tag, samples] : report.read_every) json["read_every"][tag] = samples;
  if (report.other_row != OtherRow::kNone)
    json["matches_with_cvs"] = other_row_name(report.other_row);
  for (const files::Stretch& stretch : report.used)
    json["used"].push_back(
        {{"from", seconds(stretch.from_ns)}, {"until", seconds(stretch.until_ns)}});
  for (const ChannelRecord& channel : report.channels) {
    nlohmann::ordered_json entry = json_of(channel);
    for (const char* key : {"record", "unit", "interval", "time_ns"}) entry.erase(key);
    json["channels"].push_back(std::move(entry));
  }
  for (const AlarmRecord& alarm : report.alarms) {
    nlohmann::ordered_json entry{{"time", seconds(alarm.source_time_ns)}};
    nlohmann::ordered_json record = json_of(alarm);
    for (const char* key : {"record", "unit", "time_ns"}) record.erase(key);
    entry.update(record);
    json["alarms"].push_back(std::move(entry));
  }
  json["performance"] = performance_json(report.performance);
  return json;
}

}  // namespace mpm::report
