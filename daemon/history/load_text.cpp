#include "daemon/history/load_text.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/text/number_text.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::history {
namespace {

constexpr std::size_t kMostNames = 10;

/// Events of one kind of alarms, and which alarm each is.
class Collector {
 public:
  void add(const AlarmEntry& entry) {
    const bool calls = entry.standing.annunciation == Annunciation::kUnacknowledged;
    const bool came = entry.what == to_string(AlarmOccurrence::kActive) ||
                      entry.what == to_string(AlarmOccurrence::kReannounced);
    const bool returned_from_silence = entry.what == to_string(AlarmOccurrence::kUnshelved) ||
                                       entry.what == to_string(AlarmOccurrence::kUnsuppressed) ||
                                       entry.what == to_string(AlarmOccurrence::kInService);
    const bool silent = entry.standing.silenced();
    using Kind = AlarmLoadEvent::Kind;
    if (calls && !silent && (came || returned_from_silence))
      events_.push_back({entry.written_ns, index(entry), Kind::kAnnunciated, entry.priority});
    else if (silent || entry.what == to_string(AlarmOccurrence::kCleared))
      events_.push_back({entry.written_ns, index(entry), Kind::kEnded, entry.priority});
  }
  [[nodiscard]] LoadReport::Part part(std::int64_t from_ns, std::int64_t until_ns) const {
    return {names_, alarm_load(events_, static_cast<int>(names_.size()), from_ns, until_ns)};
  }

 private:
  int index(const AlarmEntry& entry) {
    const std::string name =
        entry.cv.empty() ? entry.unit : entry.unit + ": " + entry.mv + " -> " + entry.cv;
    const auto [place, is_new] = known_.try_emplace(name, static_cast<int>(names_.size()));
    if (is_new) names_.push_back(name);
    return place->second;
  }

  std::map<std::string, int> known_;
  std::vector<std::string> names_;
  std::vector<AlarmLoadEvent> events_;
};

/// The alarms that came most often, first.
std::vector<std::size_t> most_frequent(const AlarmLoad& load) {
  std::vector<std::size_t> order(load.by_alarm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&load](std::size_t a, std::size_t b) {
    return load.by_alarm[a] > load.by_alarm[b];
  });
  while (!order.empty() && (order.size() > kMostNames || load.by_alarm[order.back()] == 0))
    order.pop_back();
  return order;
}

std::string part_text(const char* who, const LoadReport::Part& part) {
  const AlarmLoad& load = part.load;
  std::string text = std::string(who) + "\n  came        " + counted(load.annunciated, "time") +
                     ", " + number_text(load.per_day) + " a day (144 are acceptable), at most " +
                     std::to_string(load.most_in_10_min) + " in 10 minutes\n  floods      " +
                     std::to_string(load.floods) + ", " + percent_text(load.time_in_flood) +
                     " of the time (below 1 % is acceptable)\n  chattering  " +
                     counted(load.chattering, "alarm") + "\n  stale       " +
                     counted(load.stale, "alarm") + " for more than 24 h at a time\n";
  text += "  priority    high " + std::to_string(load.by_priority[2]) + ", medium " +
          std::to_string(load.by_priority[1]) + ", low " + std::to_string(load.by_priority[0]) +
          '\n';
  for (const std::size_t i : most_frequent(load))
    text += "  " + counted(load.by_alarm[i], "time") + "  " + part.names[i] + '\n';
  return text;
}

nlohmann::ordered_json part_json(const LoadReport::Part& part) {
  const AlarmLoad& load = part.load;
  nlohmann::ordered_json frequent = nlohmann::ordered_json::array();
  for (const std::size_t i : most_frequent(load))
    frequent.push_back({{"alarm", part.names[i]}, {"count", load.by_alarm[i]}});
  return {{"annunciated", load.annunciated},
          {"per_day", load.per_day},
          {"most_in_10_min", load.most_in_10_min},
          {"floods", load.floods},
          {"time_in_flood", load.time_in_flood},
          {"chattering", load.chattering},
          {"stale", load.stale},
          {"priorities",
           {{"high", load.by_priority[2]},
            {"medium", load.by_priority[1]},
            {"low", load.by_priority[0]}}},
          {"most_frequent", frequent}};
}

}  // namespace

LoadReport load_report(const AlarmStore& store, const AlarmQuery& query) {
  LoadReport report;
  Collector operators, engineers;
  bool any = false;
  store.each(query, [&](const AlarmEntry& entry) {
    if (!any) report.from_ns = entry.written_ns;
    any = true;
    report.until_ns = std::max(report.until_ns, entry.written_ns);
    const bool for_operators =
        entry.cv.empty() && entry.notification_class == NotificationClass::kAlarm;
    (for_operators ? operators : engineers).add(entry);
  });
  report.from_ns = query.since_ns.value_or(report.from_ns);
  report.until_ns = query.until_ns.value_or(report.until_ns);
  report.operators = operators.part(report.from_ns, report.until_ns);
  report.engineers = engineers.part(report.from_ns, report.until_ns);
  return report;
}

std::string load_text(const LoadReport& report) {
  if (report.from_ns == report.until_ns) return "The journal holds too little to count.\n";
  return files::utc_text(report.from_ns) + " to " + files::utc_text(report.until_ns) + ", " +
         number_text(report.engineers.load.days) + " days\n\n" +
         part_text("Operators (alarms of controllers)", report.operators) + '\n' +
         part_text("Engineers (alerts)", report.engineers);
}

nlohmann::ordered_json load_json(const LoadReport& report) {
  return {{"from_ns", report.from_ns},
          {"until_ns", report.until_ns},
          {"days", report.engineers.load.days},
          {"operators", part_json(report.operators)},
          {"engineers", part_json(report.engineers)}};
}

}  // namespace mpm::history
