#include "daemon/report/records.hpp"

namespace mpm::daemon {

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
  json["effect_size"] = record.effect_size;
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
  return {{"record", "alarm"},
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
}

}  // namespace mpm::daemon
