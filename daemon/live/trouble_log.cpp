#include "daemon/live/trouble_log.hpp"

namespace mpm::live {

std::vector<TroubleLog::Line> TroubleLog::update(const std::vector<bus::Trouble>& troubles,
                                                 Clock::time_point now) {
  std::vector<Line> lines;
  for (const bus::Trouble& trouble : troubles) {
    const auto [entry, is_new] = standing_.try_emplace(trouble.key);
    if (is_new) {
      entry->second.text = trouble.text;
      entry->second.began = now;
      lines.push_back({true, trouble.text});
    }
    entry->second.seen = now;
  }
  for (auto it = standing_.begin(); it != standing_.end();) {
    const Entry& entry = it->second;
    if (now - entry.seen < calm_) {
      ++it;
      continue;
    }
    const auto lasted = std::chrono::duration_cast<std::chrono::seconds>(entry.seen - entry.began);
    lines.push_back({false, "over after " + std::to_string(lasted.count()) + " s: " + entry.text});
    it = standing_.erase(it);
  }
  return lines;
}

}  // namespace mpm::live
