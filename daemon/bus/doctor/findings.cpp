#include "daemon/bus/doctor/findings.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"

namespace mpm::bus {
namespace {

using Json = nlohmann::ordered_json;

/// By the beginning of a trouble's key.
constexpr std::array<std::pair<std::string_view, std::string_view>, 19> kAdvice = {{
    {"no data", "See that the gateway runs, with this domain, partition and unit name."},
    {"silent", "Let the gateway publish it, or take its signals out of the unit file."},
    {"mismatch", "Give it the QoS of docs/hmi.md."},
    {"two gateways", "Stop one of them."},
    {"other monitor", "Stop one of them, or give each a partition of its own."},
    {"no monitor", "Start mpmd with the file of this unit, on this domain and partition."},
    {"length", "Publish one value per signal, in the order of the unit file."},
    {"standing", "Let the gateway count control intervals."},
    {"apart", "Give all topics of the unit the same number in the same interval."},
    {"beyond", "Let the gateway count from a smaller number."},
    {"jump", "The controller or its gateway was restarted, or lost so many samples."},
    {"layout", "Give it the tags of the unit file, in its order, and its sample time."},
    {"gaps", "See which samples the gateway does not publish, or with another number."},
    {"pace", "Let the gateway publish one sample per sample time of the unit file."},
    {"repeats", "Let the gateway publish each interval once."},
    {"clock offset", "Set the clock of the control system or of this machine."},
    {"clock", "See to the time synchronisation of the control system."},
    {"nobody", "Compare domain, partition, interface and peers with theirs."},
    {"monitor says",
     "Its log says since when: journalctl --unit mpmd, or the terminal where mpmd was started."},
}};

// Of a line that the bus has its say in: many times what an honest one takes.
constexpr std::size_t kLongestLine = 4000;

struct Line {
  std::string unit;
  const Trouble* trouble;
};

// Of all units, the worst first.
std::vector<Line> lines_of(const Findings& findings) {
  std::vector<Line> lines;
  for (const Trouble& trouble : findings.troubles) lines.push_back({"", &trouble});
  for (const UnitFindings& unit : findings.units)
    for (const Trouble& trouble : unit.troubles) lines.push_back({unit.unit, &trouble});
  std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
    return a.trouble->severity > b.trouble->severity;
  });
  return lines;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string row(const std::string& topic, const std::string& text) {
  return fmt::format("  {:<15}{}\n", topic, printable(text, kLongestLine));
}

std::string writer_text(const WriterFindings& writer) {
  std::string text = idl::name_of(writer.process);
  if (!writer.mismatch.empty()) return text + ": does not match, " + listed(writer.mismatch);
  text += ": QoS matches, ";
  if (writer.samples == 0) return text + "nothing of this unit";
  text += writer.rate_hz > 0.0 ? fmt::format("{:.3g}/s", writer.rate_hz) : "one sample";
  return text + fmt::format(", last {:.1f} s ago, clock {:+.3f} s, {} skipped, {} repeated",
                            writer.age_s, -writer.clock_offset_s, writer.skipped, writer.repeated);
}

std::string monitor_text(const MonitorFindings& monitor) {
  return idl::name_of(monitor.process) +
         fmt::format(": {}{}, {:.1f} s ago", monitor.state,
                     monitor.detail.empty() ? "" : " (" + monitor.detail + ")", monitor.age_s);
}

std::string unit_text(const UnitFindings& unit) {
  std::string text = printable(unit.unit) + (unit.place.empty() ? "" : " on " + unit.place) +
                     (unit.troubles.empty() ? ": well\n" : ": trouble\n");
  if (unit.monitors.empty()) text += row("monitor", "none");
  for (const MonitorFindings& monitor : unit.monitors)
    text += row("monitor", monitor_text(monitor));
  for (const idl::Process& standby : unit.standbys) text += row("standby", idl::name_of(standby));
  for (const TopicFindings& topic : unit.topics) {
    if (topic.writers.empty())
      text += row(topic.topic, topic.needed ? "nobody writes it" : "nobody writes it; not needed");
    for (const WriterFindings& writer : topic.writers)
      text += row(topic.topic, writer_text(writer));
  }
  return text;
}

// Samples get where they should; what the monitors make of them is theirs to say.
std::string summary(const Findings& findings) {
  std::uint64_t alarms = 0;
  std::string waiting;
  for (const UnitFindings& unit : findings.units)
    for (const MonitorFindings& monitor : unit.monitors) {
      alarms += monitor.active_alarms - std::min(monitor.active_alarms, monitor.silenced_alarms);
      if (monitor.state == to_string(Severity::kFunctionCheck) && waiting.empty())
        waiting = "; " + printable(unit.unit) + ": " + printable(monitor.detail, kLongestLine);
    }
  if (alarms == 0 && waiting.empty()) return "all is well on " + findings.place;
  return "the data path is well on " + findings.place + waiting +
         (alarms == 0 ? "" : "; " + counted(alarms, "alarm") + ": see mpm watch");
}

Json json_of(const idl::Process& process) {
  return {{"host", process.host}, {"program", process.program}, {"pid", process.pid}};
}

Json json_of(const Trouble& trouble, const std::string& unit) {
  return {{"unit", unit},
          {"severity", to_string(trouble.severity)},
          {"text", trouble.text},
          {"advice", advice(trouble)}};
}

Json json_of(const UnitFindings& unit) {
  Json monitors = Json::array(), topics = Json::array();
  for (const MonitorFindings& monitor : unit.monitors) {
    Json entry = json_of(monitor.process);
    entry.update({{"state", monitor.state},
                  {"detail", monitor.detail},
                  {"active_alarms", monitor.active_alarms},
                  {"silenced_alarms", monitor.silenced_alarms},
                  {"age_s", monitor.age_s}});
    monitors.push_back(std::move(entry));
  }
  for (const TopicFindings& topic : unit.topics) {
    Json writers = Json::array();
    for (const WriterFindings& writer : topic.writers) {
      Json entry = json_of(writer.process);
      entry.update({{"qos_matches", writer.mismatch.empty()},
                    {"mismatch", writer.mismatch},
                    {"samples", writer.samples},
                    {"rate_hz", writer.rate_hz},
                    {"age_s", writer.age_s},
                    {"clock_offset_s", writer.clock_offset_s},
                    {"skipped", writer.skipped},
                    {"repeated", writer.repeated}});
      writers.push_back(std::move(entry));
    }
    topics.push_back(
        {{"topic", topic.topic}, {"needed", topic.needed}, {"writers", std::move(writers)}});
  }
  Json json = {{"unit", unit.unit}};
  if (!unit.place.empty()) json["place"] = unit.place;
  Json standbys = Json::array();
  for (const idl::Process& standby : unit.standbys) standbys.push_back(json_of(standby));
  json.update({{"monitors", std::move(monitors)},
               {"standbys", std::move(standbys)},
               {"topics", std::move(topics)}});
  return json;
}

}  // namespace

bool Findings::all_well() const {
  return troubles.empty() && std::all_of(units.begin(), units.end(), [](const UnitFindings& unit) {
           return unit.troubles.empty();
         });
}

Findings joined(std::vector<Findings> of_places) {
  if (of_places.size() == 1) return std::move(of_places.front());
  Findings all;
  for (Findings& one : of_places) {
    all.place += (all.place.empty() ? "" : "; ") + one.place;
    for (UnitFindings& unit : one.units) {
      unit.place = one.place;
      all.units.push_back(std::move(unit));
    }
    for (Trouble& trouble : one.troubles) {
      trouble.text = one.place + ": " + trouble.text;
      all.troubles.push_back(std::move(trouble));
    }
    for (const std::string& note : one.notes) all.notes.push_back(one.place + ": " + note);
  }
  return all;
}

std::string advice(const Trouble& trouble) {
  const auto says = [&](const char* words) {
    return trouble.text.find(words) != std::string::npos;
  };
  if (says("bad since") || says("bad, the first since"))
    return "See to the instruments and their link to the control system.";
  if (says("has stopped writing") || says("stopped, or killed"))
    return "See why the gateway writes it no more.";
  // What does not match is the cause of what is silent.
  const std::string key = says("does not match") ? "mismatch" : trouble.key;
  for (const auto& [beginning, sentence] : kAdvice)
    if (key.compare(0, beginning.size(), beginning) == 0) return std::string(sentence);
  return "";
}

std::string to_text(const Findings& findings) {
  std::string text;
  for (const UnitFindings& unit : findings.units) text += unit_text(unit) + "\n";
  int number = 0;
  for (const Line& line : lines_of(findings)) {
    const std::string sentence = advice(*line.trouble);
    text += fmt::format(
        "{}. {}{}.{}\n", ++number, line.unit.empty() ? "" : printable(line.unit) + ": ",
        printable(line.trouble->text, kLongestLine), sentence.empty() ? "" : " " + sentence);
  }
  if (number == 0) text += summary(findings) + "\n";
  for (const std::string& note : findings.notes)
    text += "note: " + printable(note, kLongestLine) + "\n";
  return text;
}

Json to_json(const Findings& findings) {
  Json units = Json::array(), troubles = Json::array();
  for (const UnitFindings& unit : findings.units) units.push_back(json_of(unit));
  for (const Line& line : lines_of(findings)) troubles.push_back(json_of(*line.trouble, line.unit));
  return {{"place", findings.place},
          {"all_well", findings.all_well()},
          {"units", std::move(units)},
          {"troubles", std::move(troubles)},
          {"notes", findings.notes}};
}

}  // namespace mpm::bus
