#include "config/import_state_space.hpp"

#include <cmath>

#include "config/load_sections.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

constexpr double kSameSampleTime = 1e-6;  // relative

void check_tags(const Map& map, std::string_view key, const std::vector<std::string>& tags) {
  const Value* value = map.find(key);
  if (value == nullptr) return;
  const std::vector<Value> items = value->items();
  for (std::size_t i = 0; i < items.size() && i < tags.size(); ++i) {
    const std::optional<std::string> tag = items[i].text(kLongestTag);
    if (tag && *tag != tags[i])
      items[i].error("'" + *tag + "' stands where the unit file has '" + tags[i] + "'");
  }
  if (items.size() != tags.size()) value->error("must be the unit's " + join(tags));
}

void read_document(const Value& document, UnitConfig& config) {
  if (!document.is_map()) {
    document.error("a state space is an object of A, B, C, D and x0");
    return;
  }
  const Map map = document.map({"A", "B", "C", "D", "x0", "sample_time", "inputs", "outputs"});
  if (const Value* given = map.find("sample_time")) {
    const std::optional<double> sample_time_s = given->number(kPositive);
    if (sample_time_s &&
        std::abs(*sample_time_s - config.sample_time_s) > kSameSampleTime * config.sample_time_s)
      given->error("the unit's sample_time is " + yaml_text(config.sample_time_s) + " s");
  }
  check_tags(map, "inputs", config.input_tags());
  check_tags(map, "outputs", config.cv_tags());
  load_state_space(map, config);
}

}  // namespace

std::vector<Finding> import_state_space(const std::string& path, UnitConfig& config) {
  Report report(path);
  if (const std::optional<std::string> text = read_text_file(path, report))
    if (const std::optional<Value> document = parse_yaml(*text, report))
      read_document(*document, config);
  return report.take();
}

}  // namespace mpm::config
