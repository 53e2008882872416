#include "daemon/live/unit_health.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "config/suggest.hpp"
#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "daemon/files/aligning.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/live/lost_troubles.hpp"
#include "idl/topics.hpp"

namespace mpm::live {
namespace {

using Clock = UnitHealth::Clock;

constexpr int kSilentSamples = 10;
constexpr std::chrono::seconds kLeastSilence{5};
constexpr int kPause = 3;            // samples
constexpr int kIncompleteShows = 2;  // samples
constexpr std::chrono::seconds kLeastPause{1};
constexpr std::chrono::seconds kStandstill{5};
constexpr std::chrono::seconds kTold{60};
constexpr std::size_t kMostInDetail = 3;
constexpr std::size_t kMostTags = 3;

Clock::duration samples_or(double sample_time_s, int samples, std::chrono::seconds at_least) {
  return std::max<Clock::duration>(at_least,
                                   std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(sample_time_s * samples)));
}

bus::ExpectedInputs expected_of(const config::UnitConfig& unit) {
  bus::ExpectedInputs expected =
      bus::expected_inputs(unit, files::needed_kinds(unit), files::aligner_settings(unit).welcome);
  expected.silence = samples_or(unit.sample_time_s, kSilentSamples, kLeastSilence);
  return expected;
}

}  // namespace

UnitHealth::UnitHealth(const config::UnitConfig& unit, Clock::time_point now)
    : unit_(unit), inputs_(expected_of(unit), now), now_(now) {
  record_.unit = unit.unit;
}

void UnitHealth::go_on(Clock::time_point now) {
  if (!std::exchange(goes_on_, true)) {
    inputs_.begin(now);
  } else if (now - now_ > kStandstill) {
    stood_still_ = now;
    stood_still_for_ = now - now_;
    inputs_.stood_still(now);
  }
  now_ = now;
}

void UnitHealth::push(const idl::SampleView& sample, std::int64_t wall_ns) {
  inputs_.push(sample.kind,
               {sample.writer, sample.interval, sample.source_time_ns, sample.values.size(),
                sample.quality.size(), wall_ns},
               now_);
}

void UnitHealth::recall(const AlignerCounters& aligner) {
  record_.frames = aligner.frames;
  record_.incomplete = aligner.incomplete;
  without_ = aligner.without;
  if (aligner.frames > 0) inputs_.recall();
}

void UnitHealth::missed(std::uint64_t intervals, std::int64_t from_ns, std::int64_t until_ns) {
  const auto text = [](std::int64_t time_ns) {
    return files::formatted_utc(time_ns / kSecondNs, "%Y-%m-%dT%H:%M:%SZ");
  };
  missed_at_ = now_;
  missed_ = "this monitor was away from " + text(from_ns) + " to " + text(until_ns) + ": " +
            counted(intervals, "interval") + (intervals == 1 ? " is" : " are") + " missing";
}

void UnitHealth::move_to(std::int64_t interval, std::int64_t source_time_ns) {
  record_.interval = interval;
  record_.source_time_ns = source_time_ns;
}

void UnitHealth::count(const std::vector<ChannelRecord>& channels) {
  record_.undetermined = record_.matching = record_.mismatching = record_.active_alarms = 0;
  for (const ChannelRecord& channel : channels) {
    if (channel.verdict == Verdict::kMatch)
      ++record_.matching;
    else if (channel.verdict == Verdict::kMismatch)
      ++record_.mismatching;
    else
      ++record_.undetermined;
    if (channel.alarm == AlarmState::kActive) ++record_.active_alarms;
  }
}

void UnitHealth::count(const AlignerCounters& aligner, report::UnitMonitor& monitor) {
  if (record_.frames != aligner.frames) framed_at_ = now_;
  record_.frames = aligner.frames;
  record_.used = monitor.counters().used;
  record_.missing = aligner.missing;
  if (record_.incomplete != aligner.incomplete) note_incomplete(aligner);
  record_.late = aligner.late;
  record_.repeated = aligner.repeated;
  record_.out_of_order = aligner.out_of_order;
  record_.bad_values = monitor.counters().bad_values;
  record_.wrong_length = aligner.wrong_length;
  record_.beyond = aligner.beyond;
  record_.restarts = aligner.restarts;
  count(monitor.channels());
}

const HealthRecord& UnitHealth::judge(const Found& found, std::int64_t wall_s) {
  count(found.aligner, found.monitor);
  record_.unknown_unit = found.unknown_unit;
  record_.silenced_alarms = std::min(found.silenced_alarms, record_.active_alarms);
  troubles_ = find_troubles(found);
  keep_while_paused();
  trouble_text_ = bus::joined_text(troubles_, kMostInDetail);
  for (const TroubleLog::Line& line : trouble_log_.update(troubles_, now_, wall_s))
    spdlog::log(line.begins ? spdlog::level::warn : spdlog::level::info, "{}: {}", unit_.unit,
                line.text);
  decide();
  if (!found.in_front.empty())
    record_.detail = found.in_front + (record_.detail.empty() ? "" : "; " + record_.detail);
  return record_;
}

void UnitHealth::note_incomplete(const AlignerCounters& aligner) {
  incomplete_at_ = now_;
  record_.incomplete = aligner.incomplete;
  incomplete_without_.clear();
  for (const SignalKind kind : idl::kTopicKinds) {
    const auto k = static_cast<std::size_t>(kind);
    if (aligner.without[k] != without_[k])
      incomplete_without_.emplace_back(idl::sample_topic(kind));
  }
  without_ = aligner.without;
}

// A failure is what leaves the unit without verdicts. Whatever is wrong with some of the samples,
// while frames are made of the others verdicts come, and are in doubt.
std::vector<bus::Trouble> UnitHealth::input_troubles(const bus::Surroundings& around) const {
  std::vector<bus::Trouble> all = inputs_.troubles(around, now_);
  if (!framed_at_ || now_ - *framed_at_ >= inputs_.expected().silence) return all;
  for (bus::Trouble& trouble : all)
    if (trouble.key != bus::kNoData)
      trouble.severity = std::min(trouble.severity, bus::Severity::kOutOfSpecification);
  return all;
}

std::vector<bus::Trouble> UnitHealth::find_troubles(const Found& found) const {
  using bus::Severity;
  std::vector<bus::Trouble> all = input_troubles(found.around);
  // Where a topic is missing or has gaps or a counter jumped, that is why.
  if (incomplete_at_ &&
      now_ - *incomplete_at_ < samples_or(unit_.sample_time_s, kIncompleteShows, kLeastPause) &&
      (all.empty() || all.front().severity == Severity::kMaintenanceRequired))
    all.push_back(
        {"incomplete", Severity::kOutOfSpecification,
         "data incomplete: a control interval came without " + config::join(incomplete_without_)});
  std::vector<LostSignal> lost = found.monitor.monitor().lost();
  std::erase_if(lost, [this](const LostSignal& signal) {  // which will be told
    return signal.cause == LossCause::kNoValue && pauses(signal.kind);
  });
  for (bus::Trouble& trouble : lost_troubles(unit_, lost, all)) all.push_back(std::move(trouble));
  add_simulated(found.monitor, all);
  if (missed_at_ && now_ - *missed_at_ < kTold)
    all.push_back({"away", Severity::kOutOfSpecification, missed_, missed_});
  if (stood_still_ && now_ - *stood_still_ < kTold)
    all.push_back(
        {"standstill", Severity::kOutOfSpecification,
         fmt::format("the monitor itself stood still for {} s: its machine is too busy or was "
                     "asleep",
                     std::chrono::duration_cast<std::chrono::seconds>(stood_still_for_).count()),
         std::to_string(stood_still_->time_since_epoch().count())});
  all.insert(all.end(), found.others.begin(), found.others.end());
  sort_by_severity(all);
  return all;
}

// Predictions that came and do no longer, that cannot be used, or that are another model's. Where
// none ever came, their silence says so.
void UnitHealth::add_simulated(report::UnitMonitor& monitor,
                               std::vector<bus::Trouble>& troubles) const {
  const auto add = [&](const char* key, const char* before, const char* behind, auto&& holds) {
    std::vector<std::string> tags;
    for (std::size_t j = 0; j < unit_.cv.size(); ++j)
      if (!unit_.cv[j].prediction.empty() && holds(static_cast<int>(j)))
        tags.push_back(unit_.cv[j].tag);
    if (tags.empty()) return;
    const std::size_t named = std::min(tags.size(), kMostTags), others = tags.size() - named;
    tags.resize(named);
    std::string text = config::join(tags);
    if (others > 0) text += " and " + counted(others, "other");
    troubles.push_back({key, bus::Severity::kOutOfSpecification, before + text + behind});
  };
  const Monitor& unit = monitor.monitor();
  constexpr const char* kSimulated = "the unit file's model predicts ";
  add("simulated", kSimulated, ": no predictions come", [&](int cv) { return unit.replaced(cv); });
  add("corrected", kSimulated, ": the predictions that come are corrected by the measurement",
      [&](int cv) { return unit.corrected(cv); });
  add("other_model", "the predictions that come of ", " are not what the unit file's model gives",
      [&](int cv) { return unit.of_other_model(cv); });
}

// Its silence is not told yet.
bool UnitHealth::pauses(SignalKind kind) const {
  const std::optional<Clock::time_point> last = inputs_.stream(kind).last();
  return last && now_ - *last > samples_or(unit_.sample_time_s, kPause, kLeastPause);
}

// Less is known of a unit whose samples pause, which makes nothing better: what was told stands
// until the silence is told, or they come again.
void UnitHealth::keep_while_paused() {
  const bool pause =
      std::any_of(idl::kTopicKinds.begin(), idl::kTopicKinds.end(), [this](SignalKind kind) {
        return inputs_.expected().needed[static_cast<std::size_t>(kind)] && pauses(kind) &&
               now_ - *inputs_.stream(kind).last() < inputs_.expected().silence;
      });
  if (!pause) {
    while_data_came_ = troubles_;
    return;
  }
  for (const bus::Trouble& before : while_data_came_)
    if (std::none_of(troubles_.begin(), troubles_.end(),
                     [&](const bus::Trouble& now) { return now.key == before.key; }))
      troubles_.push_back(before);
  bus::sort_by_severity(troubles_);
}

// The worst of what NE 107 has a word for.
void UnitHealth::decide() {
  const auto set = [this](const char* state, std::string detail) {
    record_.state = state;
    record_.detail = std::move(detail);
  };
  const std::string alarms = bus::alarms_text(record_.active_alarms, record_.silenced_alarms);
  const std::string besides = trouble_text_.empty() ? "" : "; " + trouble_text_;
  const bool in_trouble = !troubles_.empty();
  const bool serious =
      in_trouble && troubles_.front().severity > bus::Severity::kMaintenanceRequired;
  const bool waiting = record_.frames == 0, any_alarm = record_.active_alarms > 0;
  const bool alarmed = record_.active_alarms > record_.silenced_alarms;
  if (serious || (in_trouble && !waiting && !alarmed))
    set(to_string(troubles_.front().severity), trouble_text_ + (any_alarm ? "; " + alarms : ""));
  else if (waiting)
    set("function_check", bus::kNoCompleteData + besides);
  else if (alarmed)
    set("maintenance_required", alarms + besides);
  else if (record_.matching + record_.mismatching == 0)
    set("function_check", bus::kNothingDetermined);
  else
    set("normal", any_alarm ? alarms : "");
}

}  // namespace mpm::live
