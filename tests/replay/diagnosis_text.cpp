#include "tests/replay/diagnosis_text.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/replay/text_hash.hpp"

namespace mpm::test {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShown = 20;    // differences
constexpr std::size_t kShort = 4;     // numbers that are kept as they are
constexpr std::size_t kWidest = 100;  // characters of a value

/// Values by where they stand, in the order of the text.
using Leaves = std::vector<std::pair<std::string, std::string>>;

bool is_series(const Json& json) {
  return json.is_array() && json.size() > kShort &&
         std::all_of(json.begin(), json.end(),
                     [](const Json& value) { return value.is_number() || value.is_null(); });
}

Json condensed(const Json& json) {
  if (is_series(json))
    return {{"length", json.size()},
            {"first", json.front()},
            {"last", json.back()},
            {"hash", hash_of(json.dump())}};
  if (!json.is_structured()) return json;
  Json result = json.is_array() ? Json::array() : Json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array())
      result.push_back(condensed(value));
    else
      result[key] = condensed(value);
  }
  return result;
}

void collect(const Json& json, const std::string& path, Leaves& leaves) {
  if (!json.is_structured() || json.empty()) {
    leaves.emplace_back(path, json.dump());
    return;
  }
  for (const auto& [key, value] : json.items()) {
    std::string inner = path;
    if (json.is_array())
      inner += '[' + key + ']';
    else
      inner += (path.empty() ? "" : ".") + key;
    collect(value, inner, leaves);
  }
}

std::string cut(const std::string& text) {
  return text.size() <= kWidest ? text : text.substr(0, kWidest) + "...";
}

/// One line for each place that differs, the first few of them.
std::string moved(const Leaves& before, const Leaves& after) {
  const std::map<std::string, std::string> old_values(before.begin(), before.end());
  const std::map<std::string, std::string> new_values(after.begin(), after.end());
  Leaves places = after;
  for (const auto& leaf : before)
    if (new_values.count(leaf.first) == 0) places.push_back(leaf);
  std::string lines;
  std::size_t count = 0;
  for (const auto& [place, ignored] : places) {
    const auto a = old_values.find(place), b = new_values.find(place);
    const bool gone = b == new_values.end(), fresh = a == old_values.end();
    if (!gone && !fresh && a->second == b->second) continue;
    if (++count > kShown) continue;
    lines += "    " + place + ": " + (fresh ? "(none)" : cut(a->second)) + " => " +
             (gone ? "(none)" : cut(b->second)) + '\n';
  }
  if (count > kShown) lines += "    and " + std::to_string(count - kShown) + " more\n";
  return lines.empty() ? "    only its layout or its order moved\n" : lines;
}

Leaves lines_in(const std::string& text) {
  Leaves leaves;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    leaves.emplace_back("line " + std::to_string(leaves.size() + 1), line);
  return leaves;
}

}  // namespace

std::string laid_out(const std::string& report) { return Json::parse(report).dump(1) + '\n'; }

std::string condensed_page(const std::string& page) {
  static const std::string kOpen = "<script type=\"application/json\" id=\"data\">";
  const std::size_t open = page.find(kOpen);
  const std::size_t close = page.find("</script>", open);
  if (open == std::string::npos || close == std::string::npos)
    throw std::runtime_error("report.html holds no data");
  const std::size_t start = open + kOpen.size();
  return condensed(Json::parse(page.substr(start, close - start))).dump(1) + '\n';
}

std::string json_difference(const std::string& before, const std::string& after) {
  Leaves old_leaves, new_leaves;
  collect(Json::parse(before), "", old_leaves);
  collect(Json::parse(after), "", new_leaves);
  return moved(old_leaves, new_leaves);
}

std::string line_difference(const std::string& before, const std::string& after) {
  return moved(lines_in(before), lines_in(after));
}

}  // namespace mpm::test
