#include <algorithm>
#include <map>

#include "config/load_sections.hpp"
#include "config/suggest.hpp"

namespace mpm::config {
namespace {

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// All tags of a unit share one name space: they are columns of one data file.
class TagReader {
 public:
  /// A new tag; empty and reported where it is none or is taken.
  std::string read(const Value& value) {
    const std::optional<std::string> tag = value.text(kLongestTag);
    if (!tag) return {};
    if (tag->front() == ' ' || tag->back() == ' ') {
      value.error("a tag must not begin or end with a space");
    } else if (*tag == "time") {
      value.error("'time' is the name of the time column and cannot be a tag");
    } else if (ends_with(*tag, ".quality")) {
      value.error("a tag must not end in '.quality', the name of a quality column");
    } else if (const auto [first, is_new] = lines_.emplace(*tag, value.line()); !is_new) {
      value.error("tag '" + *tag + "' is already used in line " + std::to_string(first->second));
    } else {
      return *tag;
    }
    return {};
  }

 private:
  std::map<std::string, int> lines_;
};

template <class Signal>
void read_description(const Map& map, Signal& signal) {
  if (const Value* unit = map.find("unit")) signal.unit = unit->free_text().value_or("");
  if (const Value* text = map.find("description"))
    signal.description = text->free_text().value_or("");
}

void read_signal(const Map& map, TagReader& tags, InputSignal& signal) {
  if (const Value* tag = map.require("tag")) signal.tag = tags.read(*tag);
  read_description(map, signal);
  read_low_high(map, signal.limits);
}

void read_signal(const Map& map, TagReader& tags, CvSignal& signal) {
  if (const Value* tag = map.require("tag")) signal.tag = tags.read(*tag);
  read_description(map, signal);
  if (const Value* tag = map.find("prediction")) signal.prediction = tags.read(*tag);
  if (const Value* tag = map.find("setpoint")) signal.setpoint = tags.read(*tag);
  read_low_high(map, signal.limits);
}

/// Signals that could not be read keep their place with an empty tag, so that nothing else shifts.
template <class Signal>
void read_list(const Map& section, std::string_view key, const std::vector<std::string>& keys,
               TagReader& tags, std::vector<Signal>& signals) {
  const Value* list = section.find(key);
  if (list == nullptr || list->is_null()) return;
  for (const Value& item : list->items()) {
    Signal signal;
    if (item.is_scalar()) {
      signal.tag = tags.read(item);
    } else {
      read_signal(item.map(keys), tags, signal);
    }
    signals.push_back(std::move(signal));
  }
}

}  // namespace

void load_signals(const Value* section, UnitConfig& config) {
  if (section == nullptr) return;
  const Map map = section->map({"mv", "dv", "cv", "aux", "raw", "calc"});
  TagReader tags;
  const std::vector<std::string> limited_keys = {"tag", "unit", "description", "low", "high"};
  const std::vector<std::string> input_keys = {"tag", "unit", "description"};
  read_list(map, "mv", limited_keys, tags, config.mv);
  read_list(map, "dv", limited_keys, tags, config.dv);
  read_list(map, "cv", {"tag", "unit", "description", "prediction", "setpoint", "low", "high"},
            tags, config.cv);
  read_list(map, "aux", input_keys, tags, config.aux);
  read_list(map, "raw", input_keys, tags, config.raw);
  load_calculated(map, config);
  if (config.mv.empty()) section->error("`mv` needs at least one manipulated variable");
  if (config.cv.empty()) section->error("`cv` needs at least one controlled variable");
}

int find_tag(const Value& value, const std::vector<std::string>& tags, std::string_view noun) {
  const std::optional<std::string> tag = value.text(kLongestTag);
  if (!tag) return -1;
  const auto found = std::find(tags.begin(), tags.end(), *tag);
  if (found != tags.end()) return static_cast<int>(found - tags.begin());
  value.error("'" + *tag + "' is no " + std::string(noun) + " of this unit" +
              suggestion(*tag, tags));
  return -1;
}

}  // namespace mpm::config
