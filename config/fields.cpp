#include "config/fields.hpp"

namespace mpm::config {
namespace {

constexpr double kLongest = 100000.0;  // samples: bounds memory and catches slipped units

}  // namespace

const std::vector<Field<MonitorSettings>>& monitor_fields() {
  using S = MonitorSettings;
  static const std::vector<Field<S>> fields = {
      {"memory", &S::memory_s, kNotNegative, "s, sample_time / (1 - lambda); 0 = 4000 samples"},
      {"fast_memory", &S::fast_memory_s, kNotNegative, "s, likewise; 0 = 1000 samples"},
      {"sliding_window", &S::sliding_window, kAny,
       "the long memory counts its samples alike instead of forgetting"},
      {"false_alarm_rate", &S::false_alarm_rate, kRatio, "of the whole unit at any one time"},
      {"gain_error_of_interest", &S::gain_error_of_interest, kPositive,
       "relative; larger errors must be visible to say match"},
      {"correlation", &S::correlation, kAny,
       "what is reported: lagged_partial | partial | conventional | alternative | spearman | "
       "rank_partial"},
      {"threshold", &S::threshold, kAny, "f_test | mean_line (the thesis's; not calibrated)"},
      {"nonlinear", &S::nonlinear, kAny, "polynomial | kernel | random_features | off"},
      {"controlling_lags", &S::controlling_lags, {.low = 1, .high = 10000}, "samples"},
      {"first_lag", &S::first_lag, {.low = -10000, .high = 10000}, "samples"},
      {"last_lag", &S::last_lag, {.low = 0, .high = 10000}, "samples"},
      {"fir_lags", &S::fir_lags, {.low = 0, .high = 10000}, "samples; 0 = derived"},
      {"residual_order", &S::residual_order, {.low = 0, .high = 1000}, "samples; 0 = derived"},
      {"tail", &S::tail_s, kNotNegative, "s; 0 = derived"},
      {"diagnosis_samples",
       &S::diagnosis_samples,
       {.low = 0, .high = 200000},
       "kept by mpmd for a diagnosis when an alarm stands; 0 = none is made"},
      {"diagnosis_period", &S::diagnosis_period_s, kNotNegative, "s, between two at least"},
      {"performance_window", &S::performance_window_s, kPositive,
       "s, that mpm/performance looks back; 100 samples at least"},
  };
  return fields;
}

const std::vector<Field<MaterialitySettings>>& materiality_fields() {
  using S = MaterialitySettings;
  static const std::vector<Field<S>> fields = {
      {"gain", &S::gain, kPositive, "relative"},
      {"time_constant", &S::time_constant, kPositive, "relative"},
      {"dead_time", &S::dead_time_s, kNotNegative,
       "s; 0 = half a sample, or 4 % of the time constant if that is more"},
      {"step_response", &S::step_response, kNotNegative,
       "relative: what changes it by less does not matter, whichever error it is"},
  };
  return fields;
}

const std::vector<Field<AlarmSettings>>& alarm_fields() {
  using S = AlarmSettings;
  static const std::vector<Field<S>> fields = {
      {"raise_p_value", &S::raise_p_value, kRatio, "raise below"},
      {"clear_p_value", &S::clear_p_value, kRatio, "clear above"},
      {"on_delay", &S::on_delay_s, kNotNegative, "s; 0 = 10 samples"},
      {"off_delay", &S::off_delay_s, kNotNegative, "s; 0 = 60 samples"},
  };
  return fields;
}

const std::vector<Field<ManagedAlarm::Settings>>& managed_alarm_fields() {
  using S = ManagedAlarm::Settings;
  static const std::vector<Field<S>> fields = {
      {"latching", &S::latching, kAny, "what has gone waits until it is acknowledged"},
      {"realarm", &S::realarm_s, kNotNegative, "s, from acknowledged on; 0 = never"},
      {"max_shelve", &S::max_shelve_s, {.low = 1.0, .high = calibration::kMostShelf}, "s"},
  };
  return fields;
}

const std::vector<Field<ControllerAlarmSettings>>& controller_alarm_fields() {
  using S = ControllerAlarmSettings;
  static const std::vector<Field<S>> fields = {
      {"class", &S::notification_class, kAny, "event | alert | alarm"},
      {"priority", &S::priority, kAny, "low | medium | high"},
      {"on_delay", &S::on_delay_s, kNotNegative, "s"},
      {"off_delay", &S::off_delay_s, kNotNegative, "s"},
      {"consequence", &S::consequence, kAny, ""},
      {"action", &S::action, kAny, ""},
      {"time_to_respond", &S::time_to_respond_s, kNotNegative, "s"},
      {"guidance", &S::guidance, kAny, ""},
      {"display_url", &S::display_url, kAny, ""},
      {"runbook", &S::runbook, kAny, ""},
  };
  return fields;
}

const std::vector<Field<DdsSettings>>& bus_fields() {
  using S = DdsSettings;
  static const std::vector<Field<S>> fields = {
      {"domain", &S::domain, {.low = 0, .high = kHighestDomain}, ""},
      {"interface", &S::interface, kAny, "network interface; empty = Cyclone's choice"},
      {"multicast", &S::multicast, kAny, ""},
      {"partition", &S::partition, kAny, "keeps plants on one network apart"},
      {"max_participants",
       &S::max_participants,
       {.low = 1, .high = 1000},
       "processes of a domain on one host, without multicast"},
      {"security", &S::security, kAny, "folder of keys (mpm keys); empty = whoever is there"},
  };
  return fields;
}

const std::vector<Field<SimulationSettings>>& simulation_fields() {
  using S = SimulationSettings;
  static const std::vector<Field<S>> fields = {
      {"prediction_horizon", &S::prediction_horizon, {.low = 1, .high = 10000}, "samples"},
      {"soft_limit_weight", &S::soft_limit_weight, kNotNegative, "per CV unit of violation"},
  };
  return fields;
}

const std::vector<Field<NoiseSettings>>& noise_fields() {
  using S = NoiseSettings;
  static const std::vector<Field<S>> fields = {
      {"sigma", &S::sigma, kNotNegative, ""},
      {"pole", &S::pole, {.low = 0, .high = 1, .high_open = true}, ""},
  };
  return fields;
}

const std::vector<Field<SetpointSettings>>& setpoint_fields() {
  using S = SetpointSettings;
  static const std::vector<Field<S>> fields = {
      {"amplitude", &S::amplitude, kNotNegative, "CV units"},
      {"hold", &S::hold_samples, {.low = 1, .high = kLongest}, "samples"},
  };
  return fields;
}

}  // namespace mpm::config
