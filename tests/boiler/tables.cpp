#include "tests/boiler/tables.hpp"

#include <cmath>

#include "daemon/report/page/wording.hpp"

namespace mpm::boiler {
namespace {

using report::rounded;

std::string squared(const std::string& unit) {
  return (unit.find('/') == std::string::npos ? unit : "(" + unit + ")") + "\u00b2";
}

double number_or_nan(const Json& json) {
  return json.is_number() ? json.get<double>() : std::nan("");
}

/// Since when a channel is in alarm; empty where it is not.
std::string alarm_text(const Json& detect, const Json& channel) {
  std::string text;
  for (const Json& alarm : detect["alarms"]) {
    if (alarm["mv"] != channel["mv"] || alarm["cv"] != channel["cv"]) continue;
    if (alarm["to"] == "active") text = report::duration(alarm["time"].get<double>());
    if (alarm["to"] == "cleared") text.clear();
  }
  return text;
}

std::string verdict_text(const Json& detect, const Json& channel) {
  std::string text = channel["verdict"];
  if (channel.contains("reason")) text += ": " + channel["reason"].get<std::string>();
  for (char& letter : text)
    if (letter == '_') letter = ' ';
  if (channel["verdict"] == "mismatch" && channel.contains("gain_error_percent"))
    text += ", gain " + rounded(channel["gain_error_percent"].get<double>(), "%");
  if (channel["verdict"] == "mismatch" && channel["material"] == false)
    text += ", too small to matter";
  const std::string alarm = alarm_text(detect, channel);
  return alarm.empty() ? text : text + ", in alarm since " + alarm;
}

}  // namespace

thesis::Control control_of(const Json& detect) {
  thesis::Control control{};
  const Json& performance = detect["performance"];
  for (std::size_t j = 0; j < control.variance.size(); ++j)
    control.variance[j] = number_or_nan(performance["cvs"][j]["control_error"]["variance"]);
  for (std::size_t i = 0; i < control.at_limits.size(); ++i)
    control.at_limits[i] = number_or_nan(performance["mvs"][i]["at_limits"]);
  return control;
}

Json control_tables(const config::UnitConfig& unit, const std::vector<ControlColumn>& columns) {
  Json variances{{"title", "Variance of the control error"},
                 {"columns", Json::array({"CV"})},
                 {"rows", Json::array()}};
  Json limits{
      {"title", "Time at limits"}, {"columns", Json::array({"MV"})}, {"rows", Json::array()}};
  for (const ControlColumn& column : columns) {
    variances["columns"].push_back(column.head);
    limits["columns"].push_back(column.head);
  }
  for (std::size_t j = 0; j < unit.cv.size(); ++j) {
    Json row = Json::array({unit.cv[j].description});
    for (const ControlColumn& column : columns)
      row.push_back(rounded(column.control.variance[j], squared(unit.cv[j].unit)));
    variances["rows"].push_back(row);
  }
  for (std::size_t i = 0; i < unit.mv.size(); ++i) {
    Json row = Json::array({unit.mv[i].description});
    for (const ControlColumn& column : columns)
      row.push_back(rounded(100.0 * column.control.at_limits[i], "%"));
    limits["rows"].push_back(row);
  }
  return Json::array({variances, limits});
}

Json verdict_table(const std::string& title, const config::UnitConfig& unit, const Json& detect) {
  Json table{{"title", title}, {"columns", Json::array({"CV"})}, {"rows", Json::array()}};
  for (const config::InputSignal& mv : unit.mv) table["columns"].push_back(mv.tag);
  for (const config::CvSignal& cv : unit.cv) {
    Json row = Json::array({cv.description});
    for (const config::InputSignal& mv : unit.mv) {
      std::string text = "\u2013";
      for (const Json& channel : detect["channels"])
        if (channel["mv"] == mv.tag && channel["cv"] == cv.tag)
          text = verdict_text(detect, channel);
      row.push_back(text);
    }
    table["rows"].push_back(row);
  }
  return table;
}

std::string alarms_said(const Json& detect) {
  std::string text;
  for (const Json& channel : detect["channels"]) {
    const std::string alarm = alarm_text(detect, channel);
    if (alarm.empty()) continue;
    text += (text.empty() ? "" : ", ") + channel["mv"].get<std::string>() + " \u2192 " +
            channel["cv"].get<std::string>() + " since " + alarm;
  }
  return text.empty() ? "none" : text;
}

int count_of(const Json& detect, const std::string& verdict) {
  int count = 0;
  for (const Json& channel : detect["channels"]) count += channel["verdict"] == verdict;
  return count;
}

std::string place_of(const Json& finding) {
  const auto text = [&](const char* key) {
    return finding[key].is_string() ? finding[key].get<std::string>() : std::string();
  };
  const std::string from = text("tag").empty() ? text("mv") : text("tag"), to = text("cv");
  return finding["title"].get<std::string>() + ": " + from +
         (from.empty() || to.empty() ? "" : " \u2192 ") + to;
}

}  // namespace mpm::boiler
