#include "daemon/http/metrics.hpp"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/text/words.hpp"
#include "daemon/http/process_load.hpp"

namespace mpm::http {
namespace {

constexpr double kNanosecond = 1e-9;
using Labels = std::vector<prometheus::ClientMetric::Label>;

/// Families in the order in which they are begun.
class Families {
 public:
  /// Those that follow are of this one.
  void begin(const char* name, const char* help, prometheus::MetricType type) {
    families_.push_back({name, help, type, {}});
  }
  void add(double value, Labels labels = {}) {
    prometheus::ClientMetric metric;
    metric.label = std::move(labels);
    (families_.back().type == prometheus::MetricType::Counter ? metric.counter.value
                                                              : metric.gauge.value) = value;
    families_.back().metric.push_back(std::move(metric));
  }
  [[nodiscard]] std::string text() const {
    return prometheus::TextSerializer().Serialize(families_);
  }

 private:
  std::vector<prometheus::MetricFamily> families_;
};

struct Unit {
  std::string name;
  std::shared_ptr<const UnitSnapshot> snapshot;
};

using prometheus::MetricType;

void add_counts(const std::vector<Unit>& units, Families& out) {
  struct Count {
    const char *name, *help;
    std::uint64_t HealthRecord::*member;
  };
  for (const Count& count :
       {Count{"mpm_frames_total", "Control intervals taken", &HealthRecord::frames},
        Count{"mpm_frames_used_total", "Control intervals that entered the statistics",
              &HealthRecord::used},
        Count{"mpm_frames_missing_total", "Control intervals of which nothing came",
              &HealthRecord::missing},
        Count{"mpm_frames_incomplete_total", "Control intervals of which some topics came",
              &HealthRecord::incomplete},
        Count{"mpm_bad_values_total", "Values of bad quality, or that no process gives",
              &HealthRecord::bad_values},
        Count{"mpm_controller_restarts_total", "Times that the controller began to count anew",
              &HealthRecord::restarts}}) {
    out.begin(count.name, count.help, MetricType::Counter);
    for (const Unit& unit : units)
      out.add(static_cast<double>(unit.snapshot->health.*count.member), {{"unit", unit.name}});
  }
  out.begin("mpm_samples_rejected_total", "Samples that were not taken, by the reason",
            MetricType::Counter);
  for (const Unit& unit : units)
    for (const auto& [reason, member] :
         {std::pair{"late", &HealthRecord::late}, std::pair{"repeated", &HealthRecord::repeated},
          std::pair{"out_of_order", &HealthRecord::out_of_order},
          std::pair{"wrong_length", &HealthRecord::wrong_length},
          std::pair{"beyond_counting", &HealthRecord::beyond}})
      out.add(static_cast<double>(unit.snapshot->health.*member),
              {{"unit", unit.name}, {"reason", reason}});
}

void add_state(const std::vector<Unit>& units, Families& out) {
  out.begin("mpm_last_frame_timestamp_seconds", "Source time of the last control interval taken",
            MetricType::Gauge);
  for (const Unit& unit : units)
    if (unit.snapshot->health.frames > 0)
      out.add(kNanosecond * static_cast<double>(unit.snapshot->health.source_time_ns),
              {{"unit", unit.name}});
  out.begin("mpm_health", "1 for the NAMUR NE 107 state of the data and the monitor, else 0",
            MetricType::Gauge);
  for (const Unit& unit : units)
    for (const char* state :
         {"normal", "maintenance_required", "function_check", "out_of_specification", "failure"})
      out.add(unit.snapshot->health.state == state ? 1.0 : 0.0,
              {{"unit", unit.name}, {"state", state}});
  out.begin("mpm_speaks", "1 while this monitor speaks for the unit, 0 while it stands by",
            MetricType::Gauge);
  for (const Unit& unit : units) out.add(unit.snapshot->speaks ? 1.0 : 0.0, {{"unit", unit.name}});
  out.begin("mpm_service_factor_ratio", "Share of time that the controller acts",
            MetricType::Gauge);
  for (const Unit& unit : units)
    if (std::isfinite(unit.snapshot->performance.service_factor))
      out.add(unit.snapshot->performance.service_factor, {{"unit", unit.name}});
}

Labels channel_labels(const Unit& unit, const std::string& mv, const std::string& cv) {
  return {{"unit", unit.name}, {"mv", mv}, {"cv", cv}};
}

void add_channels(const std::vector<Unit>& units, Families& out) {
  out.begin("mpm_verdict", "1 for the verdict on the channel, else 0", MetricType::Gauge);
  for (const Unit& unit : units)
    for (const ChannelRecord& channel : unit.snapshot->channels)
      for (const char* word : words_of(Verdict{})) {
        Labels labels = channel_labels(unit, channel.mv, channel.cv);
        labels.push_back({"verdict", word});
        out.add(to_string(channel.verdict) == word ? 1.0 : 0.0, std::move(labels));
      }
  const auto add = [&](const char* name, const char* help, double ChannelRecord::*member) {
    out.begin(name, help, MetricType::Gauge);
    for (const Unit& unit : units)
      for (const ChannelRecord& channel : unit.snapshot->channels)
        if (std::isfinite(channel.*member))
          out.add(channel.*member, channel_labels(unit, channel.mv, channel.cv));
  };
  add("mpm_partial_correlation_ratio", "Largest of the channel's lags, -1 to 1",
      &ChannelRecord::partial_correlation);
  add("mpm_p_value", "Of no mismatch in the channel", &ChannelRecord::p_value);
  add("mpm_effective_samples", "Independent samples that the verdict rests on",
      &ChannelRecord::effective_samples);
}

void add_alarms(const std::vector<Unit>& units, Families& out) {
  out.begin("mpm_alarm_active", "1 while the channel's mismatch alarm stands", MetricType::Gauge);
  for (const Unit& unit : units)
    for (const AlarmStateRecord& alarm : unit.snapshot->alarms)
      out.add(alarm.to == AlarmChange::kCleared ? 0.0 : 1.0,
              channel_labels(unit, alarm.mv, alarm.cv));
  out.begin("mpm_alarms", "Alarms of channels by their ISA-18.2 state", MetricType::Gauge);
  for (const Unit& unit : units)
    for (const char* word : words_of(AlarmWord{})) {
      int count = 0;
      for (const AlarmStateRecord& alarm : unit.snapshot->alarms)
        count += to_string(alarm.view.alarm_state) == word ? 1 : 0;
      out.add(count, {{"unit", unit.name}, {"state", word}});
    }
  out.begin("mpm_controller_alarm_active", "1 while the controller's alarm stands, for operators",
            MetricType::Gauge);
  for (const Unit& unit : units)
    out.add(unit.snapshot->controller.state == AlarmState::kActive ? 1.0 : 0.0,
            {{"unit", unit.name}});
}

void add_process(const std::string& version, std::int64_t started_ns, Families& out) {
  const ProcessLoad load = process_load();
  out.begin("mpm_build_info", "1, of this version", MetricType::Gauge);
  out.add(1.0, {{"version", version}});
  out.begin("process_resident_memory_bytes", "Memory that the process has", MetricType::Gauge);
  out.add(static_cast<double>(load.resident_bytes));
  out.begin("process_cpu_seconds_total", "Processor time of all threads", MetricType::Counter);
  out.add(load.processor_seconds);
  out.begin("process_start_time_seconds", "When it began, since 1970", MetricType::Gauge);
  out.add(kNanosecond * static_cast<double>(started_ns));
}

}  // namespace

std::string metrics_text(const Board& board, const std::string& version, std::int64_t started_ns) {
  std::vector<Unit> units;
  for (const auto& [name, unit] : board.units())
    if (auto snapshot = unit->store.snapshot(); snapshot->id > 0)
      units.push_back({name, std::move(snapshot)});
  Families out;
  add_process(version, started_ns, out);
  add_counts(units, out);
  add_state(units, out);
  add_channels(units, out);
  add_alarms(units, out);
  return out.text();
}

}  // namespace mpm::http
