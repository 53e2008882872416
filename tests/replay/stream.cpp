#include "tests/replay/stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/replay/text_hash.hpp"

namespace mpm::test {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kEvery = 300;  // samples

std::string channel_of(const Json& record) {
  return record["mv"].get<std::string>() + " -> " + record["cv"].get<std::string>();
}

Json picked(const Json& record) {
  Json line;
  for (const char* name :
       {"interval", "mv", "cv", "verdict", "reason", "to", "p_value", "statistic", "effect_size"})
    if (record.contains(name)) line[name] = record[name];
  return line;
}

/// What a condensed journal says of one channel.
struct Story {
  std::string verdict;
  double p_value = 1.0, statistic = 0.0, effect_size = 0.0;
  int changes = -1;  // the first verdict is none
  std::string alarms;
  std::vector<Json> lines;
};

using Stories = std::map<std::string, Story>;

std::string verdict_of(const Json& line) {
  const std::string verdict = line["verdict"];
  return line.contains("reason") ? verdict + " (" + line["reason"].get<std::string>() + ")"
                                 : verdict;
}

Stories stories_of(const std::string& text, std::string& hash) {
  Stories stories;
  std::istringstream stream(text);
  for (std::string text_line; std::getline(stream, text_line);) {
    const Json line = Json::parse(text_line);
    if (line.contains("journal_hash")) {
      hash = line["journal_hash"];
      continue;
    }
    Story& story = stories[channel_of(line)];
    story.lines.push_back(line);
    if (line.contains("to")) {
      const char* mark = line["to"] == "active" ? "+" : "-";
      story.alarms += (story.alarms.empty() ? "" : " ") + (mark + line["interval"].dump());
      continue;
    }
    if (verdict_of(line) != story.verdict) ++story.changes;
    story.verdict = verdict_of(line);
    story.p_value = line["p_value"];
    story.statistic = line["statistic"];
    story.effect_size = line["effect_size"];
  }
  return stories;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string change(const std::string& before, const std::string& after) {
  return before == after ? before : before + " => " + after;
}

std::string change(double before, double after) {
  if (before == after) return number(before);
  std::string text = change(number(before), number(after));
  const double share = std::abs(after - before) / std::max(std::abs(before), 1e-300);
  return number(before) == number(after) ? text + " (by " + number(share) + ")" : text;
}

std::string row(const std::vector<std::string>& cells) {
  static constexpr std::array<std::size_t, 6> kWidths = {12, 40, 28, 26, 26, 10};
  std::string line = "  ";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += cells[i];
    if (i < kWidths.size())
      line += std::string(kWidths[i] - std::min(kWidths[i], cells[i].size()), ' ') + "  ";
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string first_difference(const Story& before, const Story& after) {
  for (std::size_t i = 0; i < std::max(before.lines.size(), after.lines.size()); ++i) {
    if (i < before.lines.size() && i < after.lines.size() && before.lines[i] == after.lines[i])
      continue;
    const Json& line = i < after.lines.size() ? after.lines[i] : before.lines[i];
    return line["interval"].dump();
  }
  return "";
}

}  // namespace

std::string condensed(const std::string& journal) {
  std::map<std::string, std::string> last;  // verdict and reason by channel
  std::string text;
  std::istringstream stream(journal);
  for (std::string line; std::getline(stream, line);) {
    const Json record = Json::parse(line);
    if (record["record"] == "channel") {
      std::string& before = last[channel_of(record)];
      const std::string now = verdict_of(record);
      if (now == before && record["interval"].get<std::int64_t>() % kEvery != 0) continue;
      before = now;
    }
    text += picked(record).dump() + "\n";
  }
  return text + Json{{"journal_hash", hash_of(journal)}}.dump() + "\n";
}

std::string difference(const std::string& before_text, const std::string& after_text) {
  std::string before_hash, after_hash;
  const Stories before = stories_of(before_text, before_hash);
  const Stories after = stories_of(after_text, after_hash);
  std::string rows;
  Stories all = before;
  all.insert(after.begin(), after.end());
  for (const auto& [channel, ignored] : all) {
    const auto of = [&channel = channel](const Stories& stories) {
      const auto found = stories.find(channel);
      return found == stories.end() ? Story{} : found->second;
    };
    const Story a = of(before), b = of(after);
    if (a.lines == b.lines) continue;
    rows += row(
        {channel, change(a.verdict, b.verdict), change(a.p_value, b.p_value),
         change(a.statistic, b.statistic), change(a.effect_size, b.effect_size),
         change(std::to_string(a.changes), std::to_string(b.changes)),
         change("[" + a.alarms + "]", "[" + b.alarms + "]") + " from " + first_difference(a, b)});
  }
  if (rows.empty())
    return "  nothing that is kept moved, but the journal has other bytes (" + before_hash +
           " => " + after_hash + ")\n";
  return row({"channel", "last verdict", "p", "statistic", "effect size", "changes",
              "alarms (+ active, - cleared) at interval; first difference"}) +
         rows;
}

}  // namespace mpm::test
