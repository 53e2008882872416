#include "daemon/bus/unit_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>

#include "config/suggest.hpp"
#include "config/unit_layout.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "idl/layout_sample.hpp"
#include "idl/topics.hpp"

namespace mpm::bus {
namespace {

using Clock = std::chrono::steady_clock;

// A jump or a clock step is over at once; so long it is told.
constexpr std::chrono::seconds kTold{60};
// So long after a standstill of this process a jump is for what it missed.
constexpr std::chrono::seconds kMissed{2};
// Interval numbers of two topics that are further apart belong to two counters: what is taken in
// one go is less.
constexpr double kApart = 200.0;
// Intervals between two writers from which on they are not taken for the same numbers.
constexpr double kSameNumbers = 32.0;
// Intervals between what several topics did, from which on it is not the same.
constexpr double kSameEvent = 2.0;
// Only of topics that both came within so many sample times, and a second.
constexpr double kComing = 2.0;
// Samples of one interval in a row until its counter stands.
constexpr std::uint64_t kStanding = 10;

long long whole_seconds(Clock::duration duration) {
  return std::chrono::duration_cast<std::chrono::seconds>(duration).count();
}

std::string topic_of(SignalKind kind) { return idl::sample_topic(kind); }

// Two counters jump all the time, and that is said already.
bool counters_differ(const std::vector<Trouble>& troubles) {
  return std::any_of(troubles.begin(), troubles.end(), [](const Trouble& trouble) {
    return trouble.key == "two gateways" && trouble.severity == Severity::kFailure;
  });
}

// Who has left says nothing more. Only a list that knows somebody knows who is not there.
bool is_there(const Surroundings& around, std::uint64_t handle) {
  return around.endpoints.empty() || find_writer(around, handle) != nullptr;
}

double apart(std::int64_t a, std::int64_t b) {
  return std::abs(static_cast<double>(a) - static_cast<double>(b));
}

}  // namespace

ExpectedInputs expected_inputs(const config::UnitConfig& unit,
                               const std::array<bool, kSignalKindCount>& needed,
                               const std::array<bool, kSignalKindCount>& welcome) {
  ExpectedInputs expected;
  expected.unit = unit.unit;
  expected.sample_time_s = unit.sample_time_s;
  expected.counts = unit.counts();
  expected.needed = needed;
  expected.welcome = welcome;
  expected.file = unit;
  return expected;
}

const idl::Endpoint* find_writer(const Surroundings& around, std::uint64_t handle) {
  const auto found = std::find_if(
      around.endpoints.begin(), around.endpoints.end(),
      [&](const idl::Endpoint& endpoint) { return endpoint.writer && endpoint.handle == handle; });
  return found == around.endpoints.end() ? nullptr : &*found;
}

std::string writer_name(const Surroundings& around, std::uint64_t handle) {
  const idl::Endpoint* endpoint = find_writer(around, handle);
  return idl::name_of(endpoint == nullptr ? idl::Process() : endpoint->process);
}

std::string place_text(const idl::DomainOptions& domain) {
  return "domain " + std::to_string(domain.domain) +
         (domain.partition.empty() ? "" : ", partition '" + domain.partition + "'") +
         (idl::ignores_environment(domain) ? " (CYCLONEDDS_URI is set, but not used)" : "");
}

void UnitInputs::push(SignalKind kind, const Arrival& arrival, Clock::time_point now) {
  streams_[static_cast<std::size_t>(kind)].push(arrival, expected_.sample_time_s, now);
}

namespace {

constexpr const char* kUnknownKind = "unknown kind";
constexpr std::size_t kLongestKind = 40;
constexpr double kOtherTimesS = 30.0 * 86'400.0;  // no clock that is set by hand is so far off
constexpr std::size_t kMostWrongLayouts = 32;     // whoever writes more fills no memory

/// Nothing for a word that is none of a layout's kinds.
std::optional<SignalKind> kind_of(const char* word) {
  for (const SignalKind kind : idl::kTopicKinds)
    if (word != nullptr && std::strcmp(word, idl::kind_name(kind)) == 0) return kind;
  return std::nullopt;
}

}  // namespace

// Each writer's last word on each kind counts: it may have been put right.
void UnitInputs::hear(const mpm_Layout& layout, std::uint64_t writer) {
  if (!expected_.file) return;
  const std::optional<SignalKind> kind = kind_of(layout.kind);
  std::string wrong;
  if (!kind)
    wrong = "'" + printable(layout.kind == nullptr ? "" : layout.kind, kLongestKind) + "'";
  else if (!config::is_layout_of(*expected_.file, *kind, idl::texts_of(layout.tags)))
    wrong = "tags or their order";
  else if (layout.sample_time_s != expected_.sample_time_s)
    wrong = "sample time";
  const std::pair<std::string, std::uint64_t> place(kind ? layout.kind : kUnknownKind, writer);
  if (wrong.empty())
    wrong_layouts_.erase(place);
  else if (wrong_layouts_.size() < kMostWrongLayouts || wrong_layouts_.count(place) > 0)
    wrong_layouts_[place] = wrong;
}

void UnitInputs::forget_layout(const char* kind, std::uint64_t writer) {
  wrong_layouts_.erase({kind_of(kind) ? kind : kUnknownKind, writer});
}

void UnitInputs::add_layouts(const Surroundings& around, std::vector<Trouble>& troubles) const {
  std::map<std::string, std::string> by_writer;  // its name: what it says
  for (const auto& [place, what] : wrong_layouts_) {
    const auto& [kind, writer] = place;
    if (!is_there(around, writer)) continue;
    std::string& text = by_writer[writer_name(around, writer)];
    text += (text.empty() ? "" : ", ") + kind + " (" + what + ")";
  }
  std::string text;
  for (const auto& [name, what] : by_writer)
    text += (text.empty() ? "" : "; ") + what + " of " + name;
  if (!text.empty())
    troubles.push_back(
        {"layout", Severity::kOutOfSpecification, "layout differs from the unit file: " + text});
}

bool UnitInputs::needed(SignalKind kind) const {
  return expected_.needed[static_cast<std::size_t>(kind)];
}

bool UnitInputs::welcome(SignalKind kind) const {
  return !needed(kind) && expected_.welcome[static_cast<std::size_t>(kind)];
}

// Came in each interval, which nobody has to, and does no longer. What is sent now and then is
// never silent.
bool UnitInputs::has_stopped(SignalKind kind, Clock::time_point now) const {
  const InputStream::Recent& recent = stream(kind).recent();
  return welcome(kind) && silent(kind, now) && recent.intervals == InputStream::Recent::kMost &&
         !recent.with_gaps();
}

bool UnitInputs::silent(SignalKind kind, Clock::time_point now) const {
  return now - std::max(stream(kind).last().value_or(start_), resumed_.value_or(start_)) >=
         expected_.silence;
}

bool UnitInputs::wants_endpoints(Clock::time_point now) const {
  if (!wrong_layouts_.empty()) return true;
  return std::any_of(idl::kTopicKinds.begin(), idl::kTopicKinds.end(), [&](SignalKind kind) {
    return (needed(kind) && silent(kind, now)) || has_stopped(kind, now) || clock_off(kind, now) ||
           stream(kind).rivals(now, expected_.silence, [](std::uint64_t) { return true; }).first !=
               nullptr;
  });
}

std::vector<Trouble> UnitInputs::troubles(const Surroundings& around, Clock::time_point now) const {
  std::vector<Trouble> troubles;
  add_silence(around, now, troubles);
  add_rivals(around, now, troubles);
  add_contents(now, troubles);
  add_layouts(around, troubles);
  add_gaps(now, troubles);
  add_events(now, troubles);
  add_clock_offset(around, now, troubles);
  sort_by_severity(troubles);
  return troubles;
}

// What is known of the ones who should write.
std::string UnitInputs::why_silent(SignalKind kind, const Surroundings& around,
                                   Clock::time_point now) const {
  std::vector<std::string> writers, refused;
  std::string stopped;
  for (const idl::Endpoint& endpoint : around.endpoints) {
    if (!endpoint.writer || endpoint.topic != topic_of(kind)) continue;
    const std::string name = idl::name_of(endpoint.process);
    // Who was killed is on the list for some seconds.
    if (stream(kind).started() && endpoint.handle == stream(kind).newest().writer) stopped = name;
    if (endpoint.mismatch.empty())
      writers.push_back(name);
    else
      refused.push_back(name + " does not match: " + config::join(endpoint.mismatch));
  }
  if (!refused.empty()) return "its writer " + config::join(refused);
  if (!stopped.empty()) {
    for (const auto& [unit, writer] : around.strangers)
      if (writer_name(around, writer) == stopped)
        return stopped + " writes unit '" + unit + "', which no unit file describes, and not '" +
               expected_.unit + "'";
    return stopped + " has stopped writing it, or was killed";
  }
  if (writers.empty()) return "nobody writes it on " + around.place;
  if (!around.strangers.empty() && !stream(kind).started()) {
    std::vector<std::string> names;
    for (const auto& [unit, writer] : around.strangers) names.push_back(unit);
    return "samples come of unit '" + config::join(names) + "' only";
  }
  // Other units' samples come: perhaps under a wrong name.
  const bool one = writers.size() == 1;
  if (!around.strangers.empty())
    return config::join(writers) + (one ? " writes" : " write") + " it, but nothing of '" +
           expected_.unit + "'";
  return config::join(writers) + (one ? " has" : " have") + " not written it for " +
         std::to_string(whole_seconds(now - stream(kind).last().value_or(start_))) +
         " s: stopped, or killed";
}

void UnitInputs::add_silence(const Surroundings& around, Clock::time_point now,
                             std::vector<Trouble>& troubles) const {
  std::vector<SignalKind> quiet;
  std::size_t wanted = 0;
  bool any_started = false;
  Clock::time_point last = start_;
  for (const SignalKind kind : idl::kTopicKinds) {
    if (!needed(kind)) continue;
    ++wanted;
    any_started = any_started || stream(kind).started();
    last = std::max(last, stream(kind).last().value_or(start_));
    if (silent(kind, now)) quiet.push_back(kind);
  }
  if (!quiet.empty() && quiet.size() == wanted) {
    // One sentence where all have the same reason.
    std::vector<std::string> reasons;
    reasons.reserve(quiet.size());
    for (const SignalKind kind : quiet) reasons.push_back(why_silent(kind, around, now));
    any_started = any_started || recalled_;
    std::string text = any_started
                           ? "no data for " + std::to_string(whole_seconds(now - last)) + " s"
                           : kNothingCame;
    if (std::all_of(reasons.begin(), reasons.end(),
                    [&](const std::string& reason) { return reason == reasons.front(); }))
      text += " (" + topic_of(quiet.front()) + (quiet.size() > 1 ? " ..." : "") + ": " +
              reasons.front() + ")";
    else
      for (std::size_t i = 0; i < quiet.size(); ++i)
        text += (i == 0 ? " (" : "; ") + topic_of(quiet[i]) + ": " + reasons[i] +
                (i + 1 == quiet.size() ? ")" : "");
    troubles.push_back(
        {kNoData, any_started ? Severity::kFailure : Severity::kFunctionCheck, std::move(text)});
    troubles.back().since = last;
    return;
  }
  for (const SignalKind kind : idl::kTopicKinds)
    if (has_stopped(kind, now)) quiet.push_back(kind);
  for (const SignalKind kind : quiet) {
    const std::string since =
        stream(kind).started()
            ? " for " + std::to_string(whole_seconds(now - *stream(kind).last())) + " s"
            : "";
    // Frames come all the same, without it; where no prediction ever came it is simulated. Of one
    // that a process before this one had, or that has stopped, the monitor itself tells.
    const bool simulated = kind == SignalKind::kPrediction && !stream(kind).started() && !recalled_;
    troubles.push_back({"silent " + topic_of(kind), Severity::kOutOfSpecification,
                        "nothing on " + topic_of(kind) + since + " (" +
                            why_silent(kind, around, now) + ")" +
                            (simulated ? ": the unit file's model predicts" : "")});
    troubles.back().since = stream(kind).last().value_or(start_);
  }
}

void UnitInputs::add_rivals(const Surroundings& around, Clock::time_point now,
                            std::vector<Trouble>& troubles) const {
  const auto there = [&around](std::uint64_t handle) { return is_there(around, handle); };
  std::vector<std::string> topics;
  const InputStream::Writer* first = nullptr;
  const InputStream::Writer* second = nullptr;
  bool same = true;
  for (const SignalKind kind : idl::kTopicKinds) {
    const auto [a, b] = stream(kind).rivals(now, expected_.silence, there);
    if (a == nullptr) continue;
    topics.push_back(topic_of(kind));
    first = first == nullptr ? a : first;
    second = second == nullptr ? b : second;
    // One that has just left stays behind.
    const double since_s =
        std::chrono::duration<double>(std::max(a->last, b->last) - std::min(a->last, b->last))
            .count();
    same =
        same && apart(a->interval, b->interval) <= kSameNumbers + since_s / expected_.sample_time_s;
  }
  if (first == nullptr || second == nullptr) return;
  const std::string who = "two gateways write " + config::join(topics) + ": " +
                          writer_name(around, first->handle) + " and " +
                          writer_name(around, second->handle);
  if (same)
    troubles.push_back({"two gateways", Severity::kMaintenanceRequired,
                        who + "; of each interval the first sample counts"});
  else
    troubles.push_back({"two gateways", Severity::kFailure,
                        who + ", with other interval numbers (" + std::to_string(first->interval) +
                            ", " + std::to_string(second->interval) +
                            "): the monitor cannot tell which one is right"});
}

void UnitInputs::add_contents(Clock::time_point now, std::vector<Trouble>& troubles) const {
  const Clock::duration coming = std::max<Clock::duration>(
      std::chrono::seconds(1),
      std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(kComing * expected_.sample_time_s)));
  std::optional<SignalKind> ahead, behind;
  std::vector<std::string> beyond;
  std::int64_t beyond_at = 0;
  for (const SignalKind kind : idl::kTopicKinds) {
    const InputStream& input = stream(kind);
    if (!(needed(kind) || welcome(kind)) || !input.started() || silent(kind, now)) continue;
    if (needed(kind) && input.beyond()) {
      beyond.push_back(topic_of(kind));
      beyond_at = input.newest().interval;
      continue;
    }
    const auto count = static_cast<std::size_t>(expected_.counts.of(kind));
    const Arrival& newest = input.newest();
    // The model predicts, and set-points are awaited by nobody.
    const bool without_it = kind == SignalKind::kPrediction || welcome(kind);
    if (newest.values != count || (newest.qualities != 0 && newest.qualities != count))
      troubles.push_back({"length " + topic_of(kind),
                          without_it ? Severity::kOutOfSpecification : Severity::kFailure,
                          topic_of(kind) + " has " + counted(newest.values, "value") + " and " +
                              std::to_string(newest.qualities) +
                              " qualities where the unit file has " + counted(count, "signal")});
    if (welcome(kind)) continue;
    for (const InputStream::Writer& writer : input.writers())
      if (writer.standing >= kStanding && now - writer.last < expected_.silence)
        troubles.push_back({"standing " + topic_of(kind), Severity::kFailure,
                            topic_of(kind) + " repeats interval " +
                                std::to_string(writer.interval) + ": the counter stands"});
    if (now - *input.last() > coming) continue;
    if (!ahead || newest.interval > stream(*ahead).newest().interval) ahead = kind;
    if (!behind || newest.interval < stream(*behind).newest().interval) behind = kind;
  }
  if (!beyond.empty())
    troubles.push_back({"beyond", Severity::kFailure,
                        "interval numbers beyond 2^53 are not taken: " + config::join(beyond) +
                            (beyond.size() == 1 ? " is at " : " are at ") +
                            std::to_string(beyond_at)});
  const bool rivals = std::any_of(troubles.begin(), troubles.end(), [](const Trouble& trouble) {
    return trouble.key == "two gateways";
  });
  if (rivals || !ahead ||
      apart(stream(*ahead).newest().interval, stream(*behind).newest().interval) <= kApart)
    return;
  troubles.push_back({"apart", Severity::kFailure,
                      "interval numbers do not meet: " + topic_of(*ahead) + " is at " +
                          std::to_string(stream(*ahead).newest().interval) + ", " +
                          topic_of(*behind) + " at " +
                          std::to_string(stream(*behind).newest().interval)});
}

// Of topics that come.
void UnitInputs::add_gaps(Clock::time_point now, std::vector<Trouble>& troubles) const {
  if (counters_differ(troubles)) return;
  std::vector<std::string> gaps, off_pace;
  double time_per_interval_s = 0.0;
  for (const SignalKind kind : idl::kTopicKinds) {
    const InputStream& input = stream(kind);
    if (!needed(kind) || !input.started() || input.beyond() || silent(kind, now)) continue;
    const InputStream::Recent& recent = input.recent();
    if (recent.with_gaps())
      gaps.push_back(std::to_string(recent.left_out()) + " of the last " +
                     std::to_string(recent.intervals) + " on " + topic_of(kind));
    if (!recent.off_pace()) continue;
    off_pace.push_back(topic_of(kind));
    time_per_interval_s = recent.time_per_interval_s;
  }
  if (!gaps.empty())
    troubles.push_back(
        {"gaps", Severity::kOutOfSpecification, "intervals are missing: " + config::join(gaps)});
  if (off_pace.empty()) return;
  char text[96];
  std::snprintf(text, sizeof text, "%.3g s an interval where the unit file has %.3g s",
                time_per_interval_s, expected_.sample_time_s);
  troubles.push_back({"pace", Severity::kOutOfSpecification,
                      "the source times on " + config::join(off_pace) + " go on by " + text});
}

// Topics that did the same at the same moment, though a sample or two apart, are told as one.
void UnitInputs::add_events(Clock::time_point now, std::vector<Trouble>& troubles) const {
  if (counters_differ(troubles)) return;
  struct Jumped {
    InputStream::Jump jump;
    std::vector<std::string> topics;
  };
  struct Stepped {
    InputStream::ClockStep step;
    std::vector<std::string> topics;
  };
  std::vector<Jumped> jumps;
  std::vector<Stepped> steps;
  for (const SignalKind kind : idl::kTopicKinds) {
    if (!needed(kind)) continue;  // what may come now and then leaps all the time
    const InputStream& input = stream(kind);
    const std::optional<InputStream::Jump> jump = input.jump();
    const bool missed =
        resumed_ && jump && jump->when >= *resumed_ && jump->when - *resumed_ < kMissed;
    if (jump && !missed && now - jump->when < kTold) {
      const auto same = std::find_if(jumps.begin(), jumps.end(), [&](const Jumped& other) {
        return apart(other.jump.from, jump->from) <= kSameEvent &&
               apart(other.jump.to, jump->to) <= kSameEvent && other.jump.timely == jump->timely;
      });
      Jumped& place = same == jumps.end() ? jumps.emplace_back(Jumped{*jump, {}}) : *same;
      place.topics.push_back(topic_of(kind));
      place.jump.to_ns = std::max(place.jump.to_ns, jump->to_ns);
    }
    if (input.clock_step() && now - input.clock_step()->when < kTold) {
      const InputStream::ClockStep& step = *input.clock_step();
      const auto same = std::find_if(steps.begin(), steps.end(), [&](const Stepped& other) {
        return apart(other.step.interval, step.interval) <= kSameEvent &&
               (other.step.size_s > 0.0) == (step.size_s > 0.0);
      });
      Stepped& place = same == steps.end() ? steps.emplace_back(Stepped{step, {}}) : *same;
      place.topics.push_back(topic_of(kind));
    }
  }
  for (const auto& [jump, topics] : jumps) {
    const std::string from = std::to_string(jump.from), to = std::to_string(jump.to);
    troubles.push_back({"jump", Severity::kOutOfSpecification,
                        (jump.timely ? "no intervals came between " + from + " and " + to
                                     : "the interval number went from " + from + " to " + to) +
                            " on " + config::join(topics),
                        from + " " + to});
    troubles.back().until_ns = jump.to_ns;
  }
  for (const auto& [step, topics] : steps) {
    const std::string interval = std::to_string(step.interval);
    char size[32];
    std::snprintf(size, sizeof size, "%.0f s", std::abs(step.size_s));
    troubles.push_back({"clock", Severity::kOutOfSpecification,
                        std::string("the clock of the control system stepped ") +
                            (step.size_s > 0.0 ? "forward" : "back") + " by " + size +
                            " at interval " + interval + " on " + config::join(topics),
                        interval});
  }
}

bool UnitInputs::clock_off(SignalKind kind, Clock::time_point now) const {
  const InputStream& input = stream(kind);
  if (!needed(kind) || !input.started() || input.beyond() || silent(kind, now)) return false;
  const std::optional<double> offset_s = input.clock_offset_s(expected_.sample_time_s);
  return offset_s && std::abs(*offset_s) > clock_limit_s(expected_.sample_time_s) &&
         std::abs(*offset_s) < kOtherTimesS;
}

// Where the source's clock runs as this machine's does, and shows another time. What is replayed or
// simulated, at another speed or in other years, has no clock.
void UnitInputs::add_clock_offset(const Surroundings& around, Clock::time_point now,
                                  std::vector<Trouble>& troubles) const {
  std::map<std::string, double> offsets_s;  // by process, of its topics the one that is off most
  for (const SignalKind kind : idl::kTopicKinds) {
    if (!clock_off(kind, now) || !is_there(around, stream(kind).newest().writer)) continue;
    double& off_s = offsets_s[writer_name(around, stream(kind).newest().writer)];
    const double offset_s = *stream(kind).clock_offset_s(expected_.sample_time_s);
    if (std::abs(offset_s) > std::abs(off_s)) off_s = offset_s;
  }
  for (const auto& [process, off_s] : offsets_s) {
    char size[32];
    std::snprintf(size, sizeof size, "%.0f s ", std::abs(off_s));
    troubles.push_back({"clock offset", Severity::kMaintenanceRequired,
                        "the source times of " + process + " are " + size +
                            (off_s > 0.0 ? "ahead of" : "behind") + " this machine's clock"});
  }
}

}  // namespace mpm::bus
