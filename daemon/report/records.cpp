#include "daemon/report/records.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::report {

nlohmann::ordered_json to_json(const ChannelRecord& record) {
  nlohmann::ordered_json json{{"record", "channel"},
                              {"unit", record.unit},
                              {"interval", record.interval},
                              {"time_ns", record.source_time_ns},
                              {"mv", record.mv},
                              {"cv", record.cv},
                              {"verdict", record.verdict}};
  if (!record.reason.empty()) json["reason"] = record.reason;
  json["p_value"] = record.p_value;
  json["statistic"] = record.statistic;
  json["threshold"] = record.threshold;
  json["partial_correlation"] = record.partial_correlation;
  json["lag"] = record.lag;
  json["excited"] = record.excited;
  json["p_value_material"] = record.p_value_material;
  json["material"] = record.material;
  json["effect_size"] = record.effect_size;
  json["effect_interval"] = {record.effect_low, record.effect_high};
  json["model_gain"] = record.model_gain;
  if (record.model_gain != 0.0) {
    const auto percent = [&](double effect) {
      return 100.0 * effect / std::abs(record.model_gain);
    };
    const double sign = record.model_gain < 0.0 ? -1.0 : 1.0;
    json["gain_error_percent"] = percent(sign * record.effect_size);
    const double ends[] = {percent(sign * record.effect_low), percent(sign * record.effect_high)};
    json["gain_error_percent_interval"] = {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  }
  if (record.usual) {
    json["time_constant_ratio"] = record.time_constant_ratio;
    json["time_constant_ratio_interval"] = {record.time_constant_low, record.time_constant_high};
    json["dead_time_error"] = record.dead_time_error_s;
    json["dead_time_error_interval"] = {record.dead_time_low_s, record.dead_time_high_s};
  }
  json["smallest_error"] = record.smallest_error;
  json["effective_samples"] = record.effective_samples;
  json["alarm"] = record.alarm_active ? "active" : "cleared";
  json["partial_correlations"] = {
      {"lags",
       {record.first_lag,
        record.first_lag + static_cast<int>(record.partial_correlations.size()) - 1}},
      {"values", record.partial_correlations}};
  return json;
}

nlohmann::ordered_json to_json(const AlarmRecord& record) {
  nlohmann::ordered_json json{{"record", record.to == "diagnosed" ? "diagnosis" : "alarm"},
                              {"unit", record.unit},
                              {"interval", record.interval},
                              {"time_ns", record.source_time_ns},
                              {"mv", record.mv},
                              {"cv", record.cv},
                              {"to", record.to},
                              {"p_value", record.p_value},
                              {"statistic", record.statistic},
                              {"threshold", record.threshold},
                              {"partial_correlation", record.partial_correlation},
                              {"lag", record.lag},
                              {"effect_size", record.effect_size}};
  const NamedCause& named = record.named;
  if (named.text.empty()) return json;
  json["cause"] = nullptr;
  if (!named.cause.empty()) json["cause"] = named.cause;
  json["cause_text"] = named.text;
  json["cause_confidence"] = named.confidence;
  json["cause_parameters"] = nlohmann::ordered_json::object();
  json["cause_intervals"] = nlohmann::ordered_json::object();
  for (const CauseParameter& parameter : named.parameters) {
    json["cause_parameters"][parameter.name] = parameter.value;
    json["cause_intervals"][parameter.name] = {parameter.low, parameter.high};
  }
  return json;
}

}  // namespace mpm::report
