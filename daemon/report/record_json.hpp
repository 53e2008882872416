#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/field_key.hpp"

namespace mpm::report {

/// Adds a record's fields to a JSON object.
class JsonMaker {
 public:
  using Json = nlohmann::ordered_json;

  explicit JsonMaker(Json& json) : json_(json) {}

  // One row of a list of fields.
  void operator()(const FieldKey& key, const auto& member) const {
    if (key.shown) json_[key.name] = value_of(member);
  }

 private:
  template <class T>
  static const T& value_of(const T& value) {
    return value;
  }
  template <Worded Enum>
  static Json value_of(const Enum& value) {
    return to_string(value);
  }
  static Json value_of(const std::optional<std::string>& text) {
    return text ? Json(*text) : Json();
  }
  template <HasFields Part>
  static Json value_of(const Part& part) {
    if constexpr (requires { part.known(); })
      if (!part.known()) return nullptr;
    Json json;
    Part::fields(JsonMaker(json), part);
    return json;
  }
  template <HasFields Part>
  static Json value_of(const std::vector<Part>& parts) {
    Json json = Json::array();
    for (const Part& part : parts) json.push_back(value_of(part));
    return json;
  }
  static Json value_of(const std::vector<CauseParameter>& parameters);
  static Json value_of(const CauseIntervals& intervals);
  static Json value_of(const std::tuple<const Reason&, const std::string&>& reason);
  static Json value_of(const std::tuple<const double&, const double&>& interval);
  /// First lag, values.
  static Json value_of(const std::tuple<const int&, const std::vector<double>&>& correlations);

  Json& json_;
};

/// What the monitor says as JSON. The lines of journal and `mpm watch`, `mpm echo` and `mpm detect`
/// all come from here, so that they are the same bytes.
template <class Record>
[[nodiscard]] nlohmann::ordered_json json_of(const Record& record) {
  nlohmann::ordered_json json;
  Record::fields(JsonMaker(json), record);
  return json;
}

/// JSON as text, in one line or indented. What is no UTF-8, and comes from the bus or the command
/// line, is replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace mpm::report
