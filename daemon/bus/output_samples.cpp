#include "daemon/bus/output_samples.hpp"

namespace mpm::bus {
namespace {

// A sender of another make may leave strings out.
std::string text(const char* string) { return string == nullptr ? "" : string; }

template <class T>
report::NamedCause named_cause(const T& sample) {
  report::NamedCause named{
      text(sample.cause), text(sample.cause_text), sample.cause_confidence, {}};
  for (std::uint32_t i = 0; i < sample.cause_parameters._length; ++i) {
    const mpm_CauseParameter& parameter = sample.cause_parameters._buffer[i];
    named.parameters.push_back(
        {text(parameter.name), parameter.value, parameter.low, parameter.high});
  }
  return named;
}

template <class T>
report::AlarmRecord alarm_record(const T& sample, const char* to) {
  return {text(sample.unit),
          text(sample.mv),
          text(sample.cv),
          sample.interval,
          sample.source_time_ns,
          text(to),
          sample.p_value,
          sample.statistic,
          sample.threshold,
          sample.partial_correlation,
          sample.lag,
          sample.effect_size,
          named_cause(sample)};
}

}  // namespace

report::ChannelRecord record_of(const mpm_ChannelStatus& sample) {
  report::ChannelRecord record;
  record.unit = text(sample.unit);
  record.mv = text(sample.mv);
  record.cv = text(sample.cv);
  record.interval = sample.interval;
  record.source_time_ns = sample.source_time_ns;
  record.verdict = text(sample.verdict);
  record.reason = text(sample.reason);
  record.p_value = sample.p_value;
  record.statistic = sample.statistic;
  record.threshold = sample.threshold;
  record.partial_correlation = sample.partial_correlation;
  record.lag = sample.lag;
  record.excited = sample.excited;
  record.effect_size = sample.effect_size;
  record.smallest_error = sample.smallest_error;
  record.p_value_material = sample.p_value_material;
  record.material = sample.material;
  record.model_gain = sample.model_gain;
  record.effect_low = sample.effect_low;
  record.effect_high = sample.effect_high;
  record.usual = sample.usual;
  record.time_constant_ratio = sample.time_constant_ratio;
  record.time_constant_low = sample.time_constant_low;
  record.time_constant_high = sample.time_constant_high;
  record.dead_time_error_s = sample.dead_time_error;
  record.dead_time_low_s = sample.dead_time_low;
  record.dead_time_high_s = sample.dead_time_high;
  record.effective_samples = sample.effective_samples;
  record.alarm_active = sample.alarm_active;
  record.first_lag = sample.first_lag;
  record.partial_correlations.assign(
      sample.partial_correlations._buffer,
      sample.partial_correlations._buffer + sample.partial_correlations._length);
  return record;
}

report::AlarmRecord record_of(const mpm_Alarm& sample) {
  return alarm_record(sample, sample.state);
}

report::AlarmRecord record_of(const mpm_AlarmEvent& sample) {
  return alarm_record(sample, sample.to);
}

report::HealthRecord record_of(const mpm_Health& sample) {
  report::HealthRecord record;
  record.unit = text(sample.unit);
  record.state = text(sample.state);
  record.detail = text(sample.detail);
  record.interval = sample.interval;
  record.source_time_ns = sample.source_time_ns;
  record.frames = sample.frames;
  record.used = sample.used;
  record.missing = sample.missing;
  record.incomplete = sample.incomplete;
  record.late = sample.late;
  record.repeated = sample.repeated;
  record.out_of_order = sample.out_of_order;
  record.bad_values = sample.bad_values;
  record.wrong_length = sample.wrong_length;
  record.unknown_unit = sample.unknown_unit;
  record.restarts = sample.restarts;
  record.undetermined = sample.undetermined;
  record.matching = sample.matching;
  record.mismatching = sample.mismatching;
  record.active_alarms = sample.active_alarms;
  return record;
}

}  // namespace mpm::bus
