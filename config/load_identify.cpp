#include <map>
#include <utility>

#include "config/load_model_parts.hpp"

namespace mpm::config {
namespace {

int read_sign(const Value& value) {
  const std::optional<std::string> text = value.text();
  if (!text) return 0;
  if (*text == "+") return 1;
  if (*text == "-") return -1;
  value.error("must be \"+\" or \"-\", not '" + *text + "'");
  return 0;
}

ChannelHint read_hint(const Map& map, const ChannelPlace& place) {
  ChannelHint hint{place.cv, place.input};
  if (const Value* relation = map.find("relation")) {
    const std::optional<std::string> text = relation->text();
    if (text && *text != "none")
      relation->error("must be none, not '" + *text + "'; what the data show needs no word");
    hint.no_relation = true;
  }
  if (const Value* sign = map.find("sign")) hint.sign = read_sign(*sign);
  if (const Value* dead_time = map.find("dead_time"))
    hint.dead_time_s = dead_time->number(kNotNegative);
  if (const Value* integrating = map.find("integrating")) hint.integrating = integrating->boolean();
  const bool tells = hint.sign != 0 || hint.dead_time_s || hint.integrating;
  if (hint.no_relation && tells)
    map.place().error(
        "a channel without relation has neither sign nor dead time, and does not integrate");
  if (!hint.no_relation && !tells)
    map.place().error(
        "says nothing of its channel: give `sign`, `dead_time`, `integrating` or `relation: none`");
  return hint;
}

}  // namespace

void load_identify(const Value* section, UnitConfig& config) {
  if (section == nullptr || section->is_null()) return;
  const Map map = section->map({"channels"});
  const Value* channels = map.find("channels");
  if (channels == nullptr || channels->is_null()) return;
  const ModelSignals signals = signals_of(config);
  std::map<std::pair<int, int>, int> lines;
  for (const Value& item : channels->items()) {
    if (!item.is_map()) {
      item.error("a channel is a map such as {cv: y1, mv: u1, sign: \"+\"}");
      continue;
    }
    const Map entry = item.map({"cv", "mv", "dv", "sign", "relation", "dead_time", "integrating"});
    const ChannelPlace place = read_place(entry, signals);
    const ChannelHint hint = read_hint(entry, place);
    if (!place.known()) continue;
    const auto [first, is_new] = lines.try_emplace({place.cv, place.input}, item.line());
    if (is_new)
      config.identify.push_back(hint);
    else
      item.error("the same channel as in line " + std::to_string(first->second));
  }
}

}  // namespace mpm::config
