#include "daemon/http/diagnosis_json.hpp"

#include <array>
#include <cctype>
#include <cstdio>

namespace mpm::http {
namespace {

Json cause_json(const std::string& mv, const std::string& cv, const NamedCause& cause) {
  Json parameters = Json::object(), intervals = Json::object();
  for (const CauseParameter& parameter : cause.parameters) {
    parameters[parameter.name] = parameter.value;
    intervals[parameter.name] = {parameter.low, parameter.high};
  }
  return {{"mv", mv},
          {"cv", cv},
          {"cause", *cause.cause},
          {"cause_text", cause.text},
          {"cause_confidence", cause.confidence},
          {"cause_parameters", parameters},
          {"cause_intervals", intervals}};
}

Json outcome_json(const config::UnitConfig& unit, const live::DiagnosisOutcome& outcome) {
  Json causes = Json::array();
  const std::vector<std::string> cvs = unit.cv_tags();
  for (std::size_t c = 0; c < outcome.causes.size(); ++c)
    if (outcome.causes[c].cause)
      causes.push_back(cause_json(unit.input_tag(static_cast<int>(c / cvs.size())),
                                  cvs[c % cvs.size()], outcome.causes[c]));
  return {{"interval", outcome.interval},
          {"time_ns", outcome.time_ns},
          {"alarm_time_ns", outcome.alarm_time_ns},
          {"headline", outcome.headline},
          {"problem", outcome.problem},
          {"file_problem", outcome.file_problem},
          {"causes", causes}};
}

/// What of report.json a page shows itself.
Json excerpt(const std::string& text) {
  const Json report = Json::parse(text, nullptr, false);
  if (!report.is_object()) return nullptr;
  Json chosen = Json::object();
  for (const char* key : {"verdict", "reason", "headline", "details", "samples", "fit_samples",
                          "validation_samples", "findings", "validation", "channels"})
    if (report.contains(key)) chosen[key] = report[key];
  return chosen;
}

}  // namespace

std::string path_part(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (std::isalnum(code) != 0 || letter == '-' || letter == '.' || letter == '_' ||
        letter == '~') {
      result += letter;
      continue;
    }
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%%%02X", static_cast<unsigned>(code));
    result += hex.data();
  }
  return result;
}

Json diagnosis_json(const UnitStore& store, const KeptReports& reports) {
  const config::UnitConfig& unit = store.config();
  const std::optional<live::DiagnosisOutcome> outcome = store.diagnosis();
  Json list = Json::array();
  for (const std::string& name : reports.names(unit.unit)) {
    const std::string path = "/reports/" + path_part(unit.unit) + "/" + name + "/";
    list.push_back(
        {{"name", name}, {"html", path + "report.html"}, {"json", path + "report.json"}});
  }
  Json last;
  if (!list.empty())
    if (const auto text =
            reports.read(unit.unit, list[0]["name"].get<std::string>(), "report.json"))
      last = excerpt(*text);
  return {{"unit", unit.unit},
          {"diagnosed", unit.monitor.diagnosis_samples > 0 && unit.has_model()},
          {"last", outcome ? outcome_json(unit, *outcome) : Json()},
          {"reports", list},
          {"report", last}};
}

}  // namespace mpm::http
