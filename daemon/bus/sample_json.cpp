#include "daemon/bus/sample_json.hpp"

#include <array>

#include "core/text/printable.hpp"
#include "idl/layout_sample.hpp"

namespace mpm::bus {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestText = 1000;  // a diagnosis in words

const char* text(const char* string) { return string == nullptr ? "" : string; }

const char* quality_name(std::uint8_t code) {
  static constexpr std::array kNames = {"good", "uncertain", "bad"};
  return code < kNames.size() ? kNames[code] : "bad";
}

std::string scalar(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append(const Json& json, const std::string& indent, std::string& lines) {
  for (const auto& [name, value] : json.items()) {
    lines += indent + name + ":";
    if (value.is_object() && !value.empty()) {
      lines += '\n';
      append(value, indent + "  ", lines);
    } else {
      lines +=
          " " +
          (value.is_string() ? printable(value.get<std::string>(), kLongestText) : scalar(value)) +
          "\n";
    }
  }
}

}  // namespace

Json json_of(const mpm_Sample& sample) {
  Json values = Json::array(), quality = Json::array();
  for (std::uint32_t i = 0; i < sample.values._length; ++i)
    values.push_back(sample.values._buffer[i]);
  for (std::uint32_t i = 0; i < sample.quality._length; ++i)
    quality.push_back(quality_name(sample.quality._buffer[i]));
  return {{"unit", text(sample.unit)},
          {"interval", sample.interval},
          {"source_time_ns", sample.source_time_ns},
          {"values", std::move(values)},
          {"quality", std::move(quality)}};
}

Json json_of(const mpm_Layout& sample) {
  return {{"unit", text(sample.unit)},
          {"kind", text(sample.kind)},
          {"sample_time_s", sample.sample_time_s},
          {"tags", idl::texts_of(sample.tags)},
          {"engineering_units", idl::texts_of(sample.engineering_units)}};
}

Json json_of(const mpm_Role& sample) {
  return {{"unit", text(sample.unit)},
          {"host", text(sample.host)},
          {"process", sample.process},
          {"active", sample.active},
          {"since_ns", sample.since_ns}};
}

std::string yaml_text(const Json& json) {
  std::string lines;
  append(json, "", lines);
  return lines;
}

}  // namespace mpm::bus
