#include "daemon/bus/doctor/examination.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "config/suggest.hpp"
#include "core/text/printable.hpp"
#include "idl/topic_catalog.hpp"
#include "idl/topics.hpp"

namespace mpm::bus {
namespace {

using Clock = std::chrono::steady_clock;

// Units of a bus on which somebody makes names up.
constexpr std::size_t kMostUnits = 1000;
// A clock that is off by more is to be told; by more than a day it is a replay or a simulation.
constexpr double kClockOffS = 10.0;
constexpr double kOtherTimeS = 86400.0;
// From which on samples that repeat an interval are told.
constexpr std::uint64_t kFewestRepeated = 3;
constexpr std::uint64_t kRepeatedInverseShare = 4;
// A monitor that speaks says its health each second.
constexpr double kSpeaksEachS = 3.0;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

std::optional<SignalKind> kind_of(const char* name, const char* (*name_of)(SignalKind)) {
  for (const SignalKind kind : idl::kTopicKinds)
    if (std::strcmp(name_of(kind), name) == 0) return kind;
  return std::nullopt;
}

std::int64_t wall_ns() {
  const std::chrono::nanoseconds wall = std::chrono::system_clock::now().time_since_epoch();
  return wall.count();
}

double clock_offset_s(std::int64_t source_time_ns) {
  return 1e-9 * (static_cast<double>(wall_ns()) - static_cast<double>(source_time_ns));
}

// Whom nobody hears.
std::vector<Trouble> unheard(const std::vector<idl::Endpoint>& endpoints) {
  std::vector<Trouble> troubles;
  for (const idl::Endpoint& endpoint : endpoints) {
    if (endpoint.mismatch.empty()) continue;
    const bool input = idl::find_known_topic(endpoint.topic)->input;
    troubles.push_back({"mismatch", input ? Severity::kFailure : Severity::kMaintenanceRequired,
                        idl::name_of(endpoint.process) +
                            (endpoint.writer ? " writes " : " reads ") + endpoint.topic +
                            (endpoint.writer ? ", and nobody of ours hears it: "
                                             : ", and gets nothing of ours: ") +
                            config::join(endpoint.mismatch)});
  }
  return troubles;
}

/// Whoever has just left is not silent yet: what nobody writes is told at once.
void add_unwritten(const std::vector<Trouble>& told, UnitFindings& findings) {
  const auto has = [&told](const std::string& key) {
    return std::any_of(told.begin(), told.end(),
                       [&key](const Trouble& trouble) { return trouble.key == key; });
  };
  if (has(kNoData)) return;
  for (const TopicFindings& topic : findings.topics)
    if (topic.needed && topic.writers.empty() && !has("silent " + topic.topic))
      findings.troubles.push_back(
          {"silent " + topic.topic, Severity::kOutOfSpecification, "nobody writes " + topic.topic});
}

}  // namespace

Examination::Examination(const idl::Participant& participant, std::string place,
                         const std::vector<ExpectedInputs>& units, Clock::duration silence)
    : survey_(participant),
      place_(std::move(place)),
      start_(Clock::now()),
      silence_(silence),
      open_(units.empty()) {
  for (ExpectedInputs expected : units) {
    expected.silence = silence;
    const std::string name = expected.unit;
    units_.emplace(name, Unit{UnitInputs(std::move(expected), start_), true, {}, {}});
  }
}

void Examination::listen(std::chrono::milliseconds longest) {
  survey_.listen(longest, [this](const std::string& topic, const idl::RawSample& sample) {
    if (sample.valid) hear(topic, sample);
  });
}

Examination::Unit* Examination::unit_of(const char* name, std::uint64_t writer) {
  if (name == nullptr || *name == '\0') return nullptr;
  if (const auto it = units_.find(name); it != units_.end()) return &it->second;
  if (!open_) {
    if (strangers_.size() < kMostUnits) strangers_.emplace(printable(name), writer);
    return nullptr;
  }
  if (units_.size() >= kMostUnits) return nullptr;
  ExpectedInputs expected;
  expected.unit = name;
  expected.silence = silence_;
  return &units_.emplace(name, Unit{UnitInputs(std::move(expected), start_), false, {}, {}})
              .first->second;
}

void Examination::hear(const std::string& topic, const idl::RawSample& sample) {
  if (const auto kind = kind_of(topic.c_str(), idl::sample_topic)) {
    if (const mpm_Sample* input = samples_.decode(sample.cdr)) hear(*kind, *input, sample.writer);
  } else if (topic == idl::kLayoutTopic) {
    if (const mpm_Layout* layout = layouts_.decode(sample.cdr)) hear(*layout, sample.writer);
  } else if (topic == idl::kHealthTopic) {
    const mpm_Health* health = health_.decode(sample.cdr);
    if (health == nullptr || health->unit == nullptr) return;
    // The monitor of another unit is no stranger.
    if (!open_ && units_.find(health->unit) == units_.end()) return;
    if (Unit* unit = unit_of(health->unit, sample.writer))
      unit->monitors[sample.writer] = {health->state == nullptr ? "" : health->state,
                                       health->detail == nullptr ? "" : health->detail,
                                       health->active_alarms, health->silenced_alarms,
                                       Clock::now()};
  }
}

void Examination::hear(SignalKind kind, const mpm_Sample& sample, std::uint64_t writer) {
  Unit* unit = unit_of(sample.unit, writer);
  if (unit == nullptr) return;
  const Clock::time_point now = Clock::now();
  unit->inputs.push(kind,
                    {writer, sample.interval, sample.source_time_ns, sample.values._length,
                     sample.quality._length, wall_ns()},
                    now);
  Stream& stream = unit->streams[{kind, writer}];
  if (stream.last != Clock::time_point{}) stream.periods_s.add(seconds(now - stream.last));
  stream.last = now;
  stream.offsets_s.add(clock_offset_s(sample.source_time_ns));
}

// With a file it is compared; a unit that no file describes is what its control system says.
void Examination::hear(const mpm_Layout& layout, std::uint64_t writer) {
  if (!open_) {
    const auto known = units_.find(layout.unit == nullptr ? "" : layout.unit);
    if (known != units_.end()) known->second.inputs.hear(layout, writer);
    return;
  }
  const auto kind = layout.kind == nullptr ? std::nullopt : kind_of(layout.kind, idl::kind_name);
  if (!kind) return;
  Unit* unit = unit_of(layout.unit, writer);
  if (unit == nullptr) return;
  ExpectedInputs expected = unit->inputs.expected();
  expected.sample_time_s = layout.sample_time_s;
  const auto count = static_cast<int>(layout.tags._length);
  if (*kind == SignalKind::kMv)
    expected.counts.mv = count;
  else if (*kind == SignalKind::kDv)
    expected.counts.dv = count;
  else if (*kind == SignalKind::kRaw)
    expected.counts.raw = count;
  else
    expected.counts.cv = count;
  auto& taken = *kind == SignalKind::kSetpoint ? expected.welcome : expected.needed;
  taken[static_cast<std::size_t>(*kind)] = count > 0;
  unit->inputs.expect(std::move(expected));
  unit->described = true;
}

TopicFindings Examination::topic_of(const Unit& unit, SignalKind kind, const Surroundings& around,
                                    Clock::time_point now) const {
  TopicFindings topic;
  topic.topic = idl::sample_topic(kind);
  topic.needed = unit.inputs.expected().needed[static_cast<std::size_t>(kind)];
  for (const idl::Endpoint& endpoint : around.endpoints) {
    if (!endpoint.writer || endpoint.topic != topic.topic) continue;
    const bool others = std::any_of(units_.begin(), units_.end(), [&](const auto& other) {
      return other.second.streams.count({kind, endpoint.handle}) > 0;
    });
    const auto stream = unit.streams.find({kind, endpoint.handle});
    if (stream == unit.streams.end() && others) continue;  // a gateway of other units
    WriterFindings& writer = topic.writers.emplace_back();
    writer.process = endpoint.process;
    writer.mismatch = endpoint.mismatch;
    if (stream == unit.streams.end()) continue;
    const WindowStatistics& periods = stream->second.periods_s;
    writer.rate_hz = periods.mean() > 0.0 ? 1.0 / periods.mean() : 0.0;
    writer.age_s = seconds(now - stream->second.last);
    writer.clock_offset_s = stream->second.offsets_s.mean();
    for (const InputStream::Writer& seen : unit.inputs.stream(kind).writers())
      if (seen.samples > 0 && seen.handle == endpoint.handle) {
        writer.samples = seen.samples;
        writer.skipped = seen.skipped;
        writer.repeated = seen.repeated;
      }
  }
  return topic;
}

namespace {

/// Once for each process, whatever it writes: of its topics the one that is off most.
void add_clock_offsets(UnitFindings& findings) {
  std::map<std::string, double> offsets_s;  // by process
  for (const TopicFindings& topic : findings.topics)
    for (const WriterFindings& writer : topic.writers) {
      if (writer.samples == 0) continue;
      double& off_s = offsets_s[idl::name_of(writer.process)];
      if (std::abs(writer.clock_offset_s) > std::abs(off_s)) off_s = writer.clock_offset_s;
    }
  for (const auto& [process, off_s] : offsets_s)
    if (std::abs(off_s) > kClockOffS && std::abs(off_s) < kOtherTimeS)
      findings.troubles.push_back(
          {"clock offset", Severity::kOutOfSpecification,
           fmt::format("the source times of {} are {:.0f} s {} this machine's clock", process,
                       std::abs(off_s), off_s > 0.0 ? "behind" : "ahead of")});
}

/// "no data for 33 s" of what a monitor says, which has listened for longer; empty where it does
/// not.
std::string silence_in(const std::string& said) {
  constexpr std::string_view kFor = "no data for ";
  const std::size_t from = said.find(kFor);
  if (from == std::string::npos) return "";
  const std::size_t end = said.find(" s", from + kFor.size());
  return end == std::string::npos ? "" : said.substr(from, end + 2 - from);
}

// The same trouble with other numbers is no other one: the doctor looks a moment later.
std::string without_numbers(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  return text;
}

/// What a monitor says, without what was found here.
std::string not_told(const std::string& said, const std::vector<Trouble>& troubles) {
  constexpr std::string_view kBetween = "; ";
  std::string left;
  for (std::size_t from = 0; from < said.size();) {
    const std::size_t end = std::min(said.find(kBetween, from), said.size());
    const std::string part = said.substr(from, end - from);
    from = end + kBetween.size();
    const bool told =
        std::any_of(troubles.begin(), troubles.end(), [&part](const Trouble& trouble) {
          return without_numbers(trouble.text).find(without_numbers(part)) != std::string::npos;
        });
    if (!told) left += std::string(left.empty() ? "" : kBetween) + part;
  }
  return left;
}

bool has_trouble(const UnitFindings& findings, const std::string& key) {
  return std::any_of(findings.troubles.begin(), findings.troubles.end(),
                     [&key](const Trouble& trouble) { return trouble.key == key; });
}

}  // namespace

UnitFindings Examination::findings_of(const Unit& unit, const Surroundings& around,
                                      Clock::time_point now) const {
  UnitFindings findings;
  findings.unit = unit.inputs.expected().unit;
  for (const SignalKind kind : idl::kTopicKinds) {
    if (kind == SignalKind::kRaw && unit.inputs.expected().counts.raw == 0) continue;
    findings.topics.push_back(topic_of(unit, kind, around, now));
    for (const WriterFindings& writer : findings.topics.back().writers) {
      if (writer.repeated >= kFewestRepeated &&
          kRepeatedInverseShare * writer.repeated >= writer.samples)
        findings.troubles.push_back(
            {"repeats", Severity::kMaintenanceRequired,
             fmt::format("{} of {} samples on {} from {} repeat the interval before",
                         writer.repeated, writer.samples, findings.topics.back().topic,
                         idl::name_of(writer.process))});
    }
  }
  add_clock_offsets(findings);
  if (unit.described) {
    const std::vector<Trouble> troubles = unit.inputs.troubles(around, now);
    std::copy_if(troubles.begin(), troubles.end(), std::back_inserter(findings.troubles),
                 [&](const Trouble& trouble) {
                   return trouble.key != "clock offset" || !has_trouble(findings, trouble.key);
                 });
    add_unwritten(troubles, findings);
  }
  std::map<std::string, idl::Process> sharers;  // monitors of which one speaks
  for (const idl::Endpoint& endpoint : around.endpoints)
    if (endpoint.topic == idl::kRoleTopic && endpoint.writer && endpoint.user_data == findings.unit)
      sharers[idl::name_of(endpoint.process)] = endpoint.process;
  for (const auto& [writer, word] : unit.monitors) {
    const idl::Endpoint* endpoint = find_writer(around, writer);
    if (endpoint == nullptr) continue;  // it has left
    const double age_s = seconds(now - word.when);
    const auto shares = sharers.find(idl::name_of(endpoint->process));
    if (shares != sharers.end() && age_s > kSpeaksEachS) continue;  // it spoke before another one
    if (shares != sharers.end()) sharers.erase(shares);
    findings.monitors.push_back({endpoint->process, word.state, word.detail, word.active_alarms,
                                 age_s, word.silenced_alarms});
  }
  for (const auto& [name, process] : sharers) findings.standbys.push_back(process);
  for (Trouble& trouble : findings.troubles) {
    if (!trouble.text.starts_with(kNothingCame)) continue;
    for (const MonitorFindings& monitor : findings.monitors)
      if (const std::string silence = silence_in(monitor.detail); !silence.empty()) {
        trouble.text.replace(0, std::string_view(kNothingCame).size(), printable(silence));
        trouble.severity = Severity::kFailure;
        break;
      }
  }
  if (findings.monitors.empty())
    findings.troubles.push_back(
        {"no monitor", Severity::kMaintenanceRequired, "no monitor watches it"});
  if (findings.monitors.size() > 1)
    findings.troubles.push_back(
        {"other monitor", Severity::kMaintenanceRequired,
         "two monitors watch it: " + idl::name_of(findings.monitors[0].process) + " and " +
             idl::name_of(findings.monitors[1].process)});
  // It knows more than the bus shows, of its disk for example. Alarms are what it is there for.
  for (const MonitorFindings& monitor : findings.monitors) {
    const std::string said =
        not_told(troubles_in(monitor.detail, monitor.active_alarms, monitor.silenced_alarms),
                 findings.troubles);
    if (!said.empty())
      findings.troubles.push_back(
          {"monitor says", Severity::kMaintenanceRequired,
           idl::name_of(monitor.process) + " says " + monitor.state + ": " + said});
  }
  sort_by_severity(findings.troubles);
  return findings;
}

Findings Examination::findings() const {
  const Clock::time_point now = Clock::now();
  Surroundings around{place_, "", survey_.endpoints(), strangers_};
  Findings findings;
  findings.place = place_;
  if (around.endpoints.empty())
    findings.troubles.push_back({"nobody", Severity::kFailure, "nobody else is on " + place_});
  for (const auto& [name, unit] : units_) findings.units.push_back(findings_of(unit, around, now));
  for (Trouble& trouble : unheard(around.endpoints)) {
    // One who should write a silent topic has been named there.
    const bool told =
        std::any_of(findings.units.begin(), findings.units.end(), [&](const UnitFindings& unit) {
          return std::any_of(unit.troubles.begin(), unit.troubles.end(), [](const Trouble& other) {
            return other.text.find("does not match") != std::string::npos;
          });
        });
    if (!told || trouble.severity != Severity::kFailure)
      findings.troubles.push_back(std::move(trouble));
  }
  sort_by_severity(findings.troubles);
  std::vector<std::string> strangers;
  for (const auto& [unit, writer] : strangers_) strangers.push_back(unit);
  if (!strangers.empty())
    findings.notes.push_back("samples of other units go by: " + config::join(strangers));
  if (open_ && units_.empty() && !around.endpoints.empty())
    findings.notes.emplace_back("no unit's samples went by and no monitor spoke");
  return findings;
}

}  // namespace mpm::bus
