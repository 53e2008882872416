#include "daemon/live/trouble_log.hpp"

#include <algorithm>
#include <cctype>

#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::live {
namespace {

constexpr int kMostPerMinute = 3;      // lines of one key
constexpr std::size_t kMostTold = 16;  // texts of one key

// The same trouble with other numbers is no other one: times go on, shares vary.
std::string without_numbers(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  return text;
}

long long seconds_of(TroubleLog::Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::seconds>(duration).count();
}

}  // namespace

void TroubleLog::tell(const bus::Trouble& trouble, Clock::time_point now,
                      std::vector<Line>& lines) {
  host::RateLimiter& limit = limits_.try_emplace(trouble.key, kMostPerMinute).first->second;
  if (!limit.admit(now)) return;
  lines.push_back({true, trouble.text});
  if (limit.held_back() > 0)
    lines.back().text += " (" + std::to_string(limit.held_back()) + " more like this before)";
}

std::vector<TroubleLog::Line> TroubleLog::update(const std::vector<bus::Trouble>& troubles,
                                                 Clock::time_point now, std::int64_t wall_s) {
  std::vector<Line> lines;
  for (const bus::Trouble& trouble : troubles) {
    const bool event = !trouble.event.empty();
    const auto [place, is_new] =
        standing_.try_emplace(event ? trouble.key + " " + trouble.event : trouble.key);
    Entry& entry = place->second;
    // An event is one whatever else is said of it.
    const bool is_other = entry.told.size() < kMostTold &&
                          entry.told.insert(event ? "" : without_numbers(trouble.text)).second;
    if (is_other) tell(trouble, now, lines);
    if (is_new) {
      entry.event = event;
      entry.came = trouble.since.value_or(now);
    } else if (entry.ended_s != 0) {
      entry.stood += entry.seen - entry.came;
      entry.came = std::max(entry.seen, trouble.since.value_or(now));
      ++entry.times;
    }
    entry.text = trouble.text;
    entry.seen = now;
    entry.ended_s = 0;
  }
  for (auto it = standing_.begin(); it != standing_.end();) {
    Entry& entry = it->second;
    if (entry.seen != now && entry.ended_s == 0) entry.ended_s = wall_s;
    if (now - entry.seen < calm_) {
      ++it;
      continue;
    }
    if (!entry.event)
      lines.push_back(
          {false,
           "over since " + files::formatted_utc(entry.ended_s, "%H:%M:%SZ") + " after " +
               std::to_string(seconds_of(entry.stood + entry.seen - entry.came)) + " s" +
               (entry.times > 1 ? " in " + counted(static_cast<std::uint64_t>(entry.times), "time")
                                : "") +
               ": " + entry.text});
    it = standing_.erase(it);
  }
  return lines;
}

}  // namespace mpm::live
