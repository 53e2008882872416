#include "daemon/report/record_json.hpp"

#include "core/record/reason_text.hpp"

namespace mpm::report {

using Json = nlohmann::ordered_json;

Json JsonMaker::value_of(const std::vector<CauseParameter>& parameters) {
  Json json = Json::object();
  for (const CauseParameter& parameter : parameters) json[parameter.name] = parameter.value;
  return json;
}

Json JsonMaker::value_of(const CauseIntervals& intervals) {
  Json json = Json::object();
  for (const CauseParameter& parameter : intervals.parameters)
    json[parameter.name] = {parameter.low, parameter.high};
  return json;
}

Json JsonMaker::value_of(const std::tuple<const Reason&, const std::string&>& reason) {
  return reason_text(std::get<0>(reason), std::get<1>(reason));
}

Json JsonMaker::value_of(const std::tuple<const double&, const double&>& interval) {
  return {std::get<0>(interval), std::get<1>(interval)};
}

Json JsonMaker::value_of(const std::tuple<const int&, const std::vector<double>&>& correlations) {
  const auto& [first_lag, values] = correlations;
  return {{"lags", {first_lag, first_lag + static_cast<int>(values.size()) - 1}},
          {"values", values}};
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mpm::report
