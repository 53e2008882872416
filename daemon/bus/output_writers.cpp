#include "daemon/bus/output_writers.hpp"

#include <vector>

namespace mpm::bus {
namespace {

// The C types have no const; writing does not touch what they point to.
char* borrow(const std::string& text) { return const_cast<char*>(text.c_str()); }

std::vector<mpm_CauseParameter> parameters_of(const report::NamedCause& named) {
  std::vector<mpm_CauseParameter> parameters;
  for (const report::CauseParameter& parameter : named.parameters)
    parameters.push_back({borrow(parameter.name), parameter.value, parameter.low, parameter.high});
  return parameters;
}

// mpm_Alarm and mpm_AlarmEvent differ in one name.
template <class T>
T alarm_sample(const report::AlarmRecord& record, std::vector<mpm_CauseParameter>& parameters) {
  T sample{};
  sample.unit = borrow(record.unit);
  sample.mv = borrow(record.mv);
  sample.cv = borrow(record.cv);
  sample.interval = record.interval;
  sample.source_time_ns = record.source_time_ns;
  sample.p_value = record.p_value;
  sample.statistic = record.statistic;
  sample.threshold = record.threshold;
  sample.partial_correlation = record.partial_correlation;
  sample.lag = record.lag;
  sample.effect_size = record.effect_size;
  sample.cause = borrow(record.named.cause);
  sample.cause_text = borrow(record.named.text);
  sample.cause_confidence = record.named.confidence;
  const auto count = static_cast<std::uint32_t>(parameters.size());
  sample.cause_parameters = {count, count, parameters.data(), false};
  return sample;
}

}  // namespace

OutputWriters::OutputWriters(const idl::Participant& participant)
    : channel_status_(participant, idl::kChannelStatusTopic, idl::channel_status_writer_qos()),
      alarm_(participant, idl::kAlarmTopic, idl::alarm_qos()),
      alarm_event_(participant, idl::kAlarmEventTopic, idl::alarm_event_writer_qos()),
      health_(participant, idl::kHealthTopic, idl::health_qos()) {}

bool OutputWriters::write(const report::ChannelRecord& record) const {
  const auto count = static_cast<std::uint32_t>(record.partial_correlations.size());
  mpm_ChannelStatus sample{};
  sample.unit = borrow(record.unit);
  sample.mv = borrow(record.mv);
  sample.cv = borrow(record.cv);
  sample.interval = record.interval;
  sample.source_time_ns = record.source_time_ns;
  sample.verdict = borrow(record.verdict);
  sample.reason = borrow(record.reason);
  sample.p_value = record.p_value;
  sample.statistic = record.statistic;
  sample.threshold = record.threshold;
  sample.partial_correlation = record.partial_correlation;
  sample.lag = record.lag;
  sample.excited = record.excited;
  sample.effect_size = record.effect_size;
  sample.smallest_error = record.smallest_error;
  sample.p_value_material = record.p_value_material;
  sample.material = record.material;
  sample.model_gain = record.model_gain;
  sample.effect_low = record.effect_low;
  sample.effect_high = record.effect_high;
  sample.usual = record.usual;
  sample.time_constant_ratio = record.time_constant_ratio;
  sample.time_constant_low = record.time_constant_low;
  sample.time_constant_high = record.time_constant_high;
  sample.dead_time_error = record.dead_time_error_s;
  sample.dead_time_low = record.dead_time_low_s;
  sample.dead_time_high = record.dead_time_high_s;
  sample.effective_samples = record.effective_samples;
  sample.alarm_active = record.alarm_active;
  sample.first_lag = record.first_lag;
  sample.partial_correlations = {count, count,
                                 const_cast<double*>(record.partial_correlations.data()), false};
  return channel_status_.write(sample);
}

bool OutputWriters::write(const report::AlarmRecord& record) const {
  const bool event_written = write_event(record);
  return write_state(record) && event_written;
}

bool OutputWriters::write_event(const report::AlarmRecord& record) const {
  std::vector<mpm_CauseParameter> parameters = parameters_of(record.named);
  auto event = alarm_sample<mpm_AlarmEvent>(record, parameters);
  event.to = borrow(record.to);
  return alarm_event_.write(event);
}

bool OutputWriters::write_state(const report::AlarmRecord& record) const {
  static const std::string active = "active";
  std::vector<mpm_CauseParameter> parameters = parameters_of(record.named);
  auto state = alarm_sample<mpm_Alarm>(record, parameters);
  state.state = borrow(record.to == "diagnosed" ? active : record.to);
  return alarm_.write(state);
}

bool OutputWriters::write(const report::HealthRecord& record) const {
  mpm_Health sample{};
  sample.unit = borrow(record.unit);
  sample.state = borrow(record.state);
  sample.detail = borrow(record.detail);
  sample.interval = record.interval;
  sample.source_time_ns = record.source_time_ns;
  sample.frames = record.frames;
  sample.used = record.used;
  sample.missing = record.missing;
  sample.incomplete = record.incomplete;
  sample.late = record.late;
  sample.repeated = record.repeated;
  sample.out_of_order = record.out_of_order;
  sample.bad_values = record.bad_values;
  sample.wrong_length = record.wrong_length;
  sample.unknown_unit = record.unknown_unit;
  sample.restarts = record.restarts;
  sample.undetermined = record.undetermined;
  sample.matching = record.matching;
  sample.mismatching = record.mismatching;
  sample.active_alarms = record.active_alarms;
  return health_.write(sample);
}

}  // namespace mpm::bus
