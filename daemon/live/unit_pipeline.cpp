#include "daemon/live/unit_pipeline.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "config/suggest.hpp"
#include "core/archive/archive.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/aligning.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/keys/check_keys.hpp"
#include "daemon/live/lost_troubles.hpp"
#include "daemon/report/channel_text.hpp"
#include "daemon/report/unit_performance.hpp"
#include "idl/topics.hpp"

namespace mpm::live {
namespace {

constexpr std::chrono::seconds kHealthPeriod{1};
constexpr int kSilentSamples = 10;
constexpr int kPause = 3;  // samples
// The loop turns five times a second at least.
constexpr std::chrono::seconds kStandstill{5};
constexpr std::chrono::seconds kTold{60};
// Another monitor says something each second.
constexpr std::chrono::seconds kOtherMonitorGone{10};
// A monitor that starts is found within a second or so.
constexpr std::chrono::seconds kPartnerKnown{10};
constexpr std::size_t kMostInDetail = 3;
constexpr std::int64_t kSecond = 1'000'000'000;  // ns
// Of those without the token, to be kept: enough to see who tries, too few to fill a journal.
constexpr int kMostRefusals = 60;
constexpr std::chrono::minutes kRefusalPeriod{1};

host::RateLimiter::Clock::duration samples_or(double sample_time_s, int samples,
                                              std::chrono::seconds at_least) {
  return std::max<host::RateLimiter::Clock::duration>(
      at_least, std::chrono::duration_cast<host::RateLimiter::Clock::duration>(
                    std::chrono::duration<double>(sample_time_s * samples)));
}

bus::ExpectedInputs expected_of(const config::UnitConfig& unit) {
  bus::ExpectedInputs expected = bus::expected_inputs(unit, files::needed_kinds(unit));
  expected.silence = samples_or(unit.sample_time_s, kSilentSamples, std::chrono::seconds(5));
  return expected;
}

/// Null where the model has no such channel, whose gain an error could be told by.
const ChannelRecord* modelled_channel(const config::UnitConfig& unit,
                                      const std::vector<ChannelRecord>& channels,
                                      const AlarmRecord& alarm) {
  if (!report::channel_file(unit, alarm.mv, alarm.cv).modelled) return nullptr;
  const auto it = std::find_if(channels.begin(), channels.end(), [&](const ChannelRecord& channel) {
    return channel.mv == alarm.mv && channel.cv == alarm.cv;
  });
  return it == channels.end() ? nullptr : &*it;
}

// What is of another length changes nothing, whoever sent it and however long it is.
bool fits(const BlockView& block, const SignalCounts& counts) {
  const auto count = static_cast<std::size_t>(counts.of(block.kind));
  return block.values.size() == count && (block.quality.empty() || block.quality.size() == count);
}

}  // namespace

UnitPipeline::UnitPipeline(const config::UnitConfig& config, const idl::OutputWriters& outputs,
                           SampleJournal* samples, Clock::time_point now)
    : config_(config),
      outputs_(outputs),
      samples_(samples),
      monitor_(config),
      alarms_(config, outputs_, monitor_.channels()),
      performance_(report::performance_setup(config),
                   config.monitor.performance_window_s / config.sample_time_s),
      calculator_(config),
      calculated_(config.counts()),
      aligner_(
          config.counts(), files::needed_kinds(config),
          [this](const Frame& frame) {
            calculated_ = frame;
            calculator_.fill(calculated_);
            recalling_ ? recall_frame(calculated_) : on_frame(calculated_);
          },
          files::aligner_settings(config)),
      patience_(files::frame_patience(config)),
      inputs_(expected_of(config), now),
      now_(now),
      last_frame_(now),
      next_health_(now),
      refusal_limit_(kMostRefusals, kRefusalPeriod) {
  health_.unit = config.unit;
  for (const config::InputSignal& aux : config.aux)
    for (const config::CalculatedSignal& signal : config.calc)
      if (config.calculation_of(aux.tag) == nullptr &&
          std::find(signal.inputs.begin(), signal.inputs.end(), aux.tag) != signal.inputs.end())
        spdlog::warn(
            "{}: '{}' has no value here: it is calculated from '{}', and aux signals are in files "
            "only; in signals.raw it would come on {}",
            config.unit, signal.tag, aux.tag, idl::sample_topic(SignalKind::kRaw));
}

UnitPipeline::~UnitPipeline() {
  if (journal_) journal_->finish();
}

void UnitPipeline::diagnose_with(DiagnosisWorker& worker, int asker) {
  if (config_.monitor.diagnosis_samples == 0 || !config_.has_model()) return;
  const auto needed = needed_samples(config_.model);
  if (config_.monitor.diagnosis_samples < needed)
    spdlog::warn(
        "{}: no alarm will be diagnosed: that takes {} samples, and diagnosis_samples is {}",
        config_.unit, needed, config_.monitor.diagnosis_samples);
  else
    diagnosis_.emplace(std::make_shared<const config::UnitConfig>(config_), worker, asker);
}

// Of two monitors a reader keeps the last word, and one that starts clears all alarms. While
// another one speaks an alarm of either stands; when it has left, what this one says holds.
void UnitPipeline::publish_alarms_again() {
  const bool speaks = other_monitor_speaks();
  const bool left = other_monitor_spoke_ && !speaks;
  other_monitor_spoke_ = speaks;
  if (!speaks && !left) return;
  if (!alarms_.publish_again(left) && output_limit_.admit(now_))
    spdlog::warn("{}: the alarms could not be published anew", config_.unit);
}

bool UnitPipeline::other_monitor_speaks() const {
  return std::any_of(other_monitors_.begin(), other_monitors_.end(), [this](const auto& other) {
    return now_ - other.second.heard < kOtherMonitorGone;
  });
}

// In the same words from each of them: a reader gets what they say in turn.
std::string UnitPipeline::monitors_text(const std::string& self) const {
  std::vector<std::string> names = {self};
  for (const auto& [writer, other] : other_monitors_)
    if (now_ - other.heard < kOtherMonitorGone) names.push_back(other.name);
  std::sort(names.begin(), names.end());
  return std::to_string(names.size()) +
         " monitors watch this unit: " + config::join(names, kMostInDetail) +
         "; readers see them in turn";
}

void UnitPipeline::push(const idl::SampleView& sample, Clock::time_point now) {
  go_on(now);
  if (!aligner_.pending()) last_frame_ = now;  // patience counts from here
  inputs_.push(sample.kind,
               {sample.writer, sample.interval, sample.source_time_ns, sample.values.size(),
                sample.quality.size()},
               now);
  const AlignerCounters before = aligner_.counters();
  const BlockView block{sample.kind, sample.interval, sample.source_time_ns, sample.values,
                        sample.quality};
  if (log_ && fits(block, config_.counts()))
    if (const auto begun = log_->push(block)) keep_state(*begun);
  aligner_.push(block);
  const AlignerCounters& after = aligner_.counters();
  if (after.wrong_length != before.wrong_length) report_refused(sample);
  if (after.beyond != before.beyond && beyond_limit_.admit(now))
    spdlog::warn("{}: {} sample of interval {}: numbers beyond 2^53 are not taken; ignored{}",
                 config_.unit, idl::sample_topic(sample.kind), sample.interval,
                 beyond_limit_.held_back() == 0
                     ? ""
                     : fmt::format(" ({} more like this before)", beyond_limit_.held_back()));
  if (after.restarts != before.restarts && restart_limit_.admit(now))
    spdlog::info("{}: the controller restarted: interval {} after {}{}", config_.unit,
                 sample.interval, health_.interval,
                 restart_limit_.held_back() == 0
                     ? ""
                     : fmt::format(" ({} more like this before)", restart_limit_.held_back()));
}

// Samples may be the first that is seen after a standstill, and are not to be blamed for it.
void UnitPipeline::go_on(Clock::time_point now) {
  if (now - now_ > kStandstill) {
    stood_still_ = now;
    stood_still_for_ = now - now_;
    inputs_.stood_still(now);
  }
  now_ = now;
}

void UnitPipeline::report_refused(const idl::SampleView& sample) {
  if (!refused_limit_.admit(now_)) return;
  spdlog::warn(
      "{}: {} sample of interval {} has {} values and {} qualities, expected {}; ignored{}",
      config_.unit, idl::sample_topic(sample.kind), sample.interval, sample.values.size(),
      sample.quality.size(), config_.counts().of(sample.kind),
      refused_limit_.held_back() == 0
          ? ""
          : fmt::format(" ({} more like this before)", refused_limit_.held_back()));
}

void UnitPipeline::on_frame(const Frame& frame) {
  last_frame_ = now_;
  health_.interval = frame.interval;
  health_.source_time_ns = frame.source_time_ns;
  monitor_.push(frame);

  bool written = true;
  for (const ChannelRecord& channel : monitor_.channels())
    written = outputs_.write(channel) && written;
  const std::vector<std::string> texts = alarm_texts();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const AlarmRecord& alarm = monitor_.alarms()[i];
    spdlog::log(alarm.to == AlarmChange::kActive ? spdlog::level::warn : spdlog::level::info,
                "{}: {} -> {}: alarm {} at interval {} ({}, p {:.1e})", alarm.unit, alarm.mv,
                alarm.cv, to_string(alarm.to), alarm.interval, texts[i], alarm.p_value);
  }
  written = alarms_.push(monitor_.channels(), monitor_.alarms(), texts, wall_ns()) && written;
  if (!written && output_limit_.admit(now_))
    spdlog::warn("{}: interval {} could not be published completely", config_.unit, frame.interval);
  if (performance_.push(frame, monitor_.monitor().judged())) publish_performance();
  // Of either the problem is in the health.
  if (journal_) journal_->push(monitor_);
  if (samples_ != nullptr) (void)samples_->write(monitor_.channels(), monitor_.alarms());
  if (observer_ != nullptr) {
    observer_->on_frame(frame, monitor_);
    for (std::size_t i = 0; i < texts.size(); ++i)
      observer_->on_alarm(monitor_.alarms()[i], texts[i]);
  }
  // Last, when everybody has been told: it may copy the unit's samples.
  if (diagnosis_) diagnosis_->push(frame, monitor_.alarms());
}

// What is wrong with the channel of each alarm of the last frame; allocates where there is one.
std::vector<std::string> UnitPipeline::alarm_texts() {
  std::vector<std::string> texts;
  for (const AlarmRecord& alarm : monitor_.alarms())
    texts.push_back(
        report::error_text(alarm, modelled_channel(config_, monitor_.channels(), alarm)));
  return texts;
}

// A diagnosis that was due then is made again, for the causes that alarms were given are nowhere
// else: only the last of them is left when the unit goes on.
void UnitPipeline::recall_frame(const Frame& frame) {
  health_.interval = frame.interval;
  health_.source_time_ns = frame.source_time_ns;
  monitor_.push(frame);
  (void)performance_.push(frame, monitor_.monitor().judged());
  if (!monitor_.alarms().empty())
    alarms_.recall(monitor_.channels(), monitor_.alarms(), alarm_texts());
  if (observer_ != nullptr) observer_->on_recalled(frame, &monitor_);
  if (diagnosis_) diagnosis_->push(frame, monitor_.alarms());
}

// All that the samples have made, as far as what is said of them depends on it.
void UnitPipeline::archive(Archive& a) {
  // not archived: config_, outputs_, calculator_, patience_, observer_ (construction)
  // not archived: samples_, journal_, log_, states_, files_between_states_, next_state_ (the disk)
  // not archived: recalling_, calculated_ (empty between calls)
  // not archived: health_ (made of the others)
  // not archived: now_, last_frame_, next_health_, stood_still_, stood_still_for_, incomplete_at_,
  // refused_limit_, beyond_limit_, output_limit_, restart_limit_, refusal_limit_ (the clock)
  // not archived: inputs_, trouble_log_, troubles_, trouble_text_, other_monitors_,
  // other_monitor_spoke_, keys_until_, role_, role_begins_, told_ (what is around this process)
  a(aligner_, monitor_, performance_, alarms_);
  if (diagnosis_) a(*diagnosis_);
}

// Before the first sample of that file is acted upon: what the file holds comes behind the state.
void UnitPipeline::keep_state(std::uint64_t file) {
  states_->poll();
  log_->hold_from(states_->oldest());
  if (file < next_state_) return;
  next_state_ = file + files_between_states_;
  states_->keep(file, [this](std::vector<std::byte>& bytes) {
    Archive away(bytes);
    archive(away);
  });
}

// The file of the log behind the last state that there is; 0: there is none, and all stays as
// construction made it.
std::uint64_t UnitPipeline::take_back_state() {
  std::vector<std::byte> constructed;
  Archive away(constructed);
  archive(away);
  for (const std::uint64_t file : states_->find(log_->files())) {
    const std::optional<std::vector<std::byte>> bytes = states_->read(file);
    if (!bytes) continue;
    try {
      Archive back{std::span(*bytes)};
      archive(back);
      back.require(back.left() == 0, "more bytes than belong there");
      health_.interval = monitor_.interval();
      health_.source_time_ns = monitor_.source_time_ns();
      if (diagnosis_) diagnosis_->resume(alarms_.channels());
      return file;
    } catch (const std::runtime_error& error) {
      spdlog::warn("{}: state {}: {}", config_.unit, file, error.what());
      Archive back{std::span(constructed)};
      archive(back);
    }
  }
  return 0;
}

std::string UnitPipeline::recall(const UnitSamples& samples) {
  log_.emplace(samples.folder, samples.meaning, samples.keep);
  states_.emplace(samples.folder, samples.owner);
  files_between_states_ = samples.files_between_states;
  const std::uint64_t from = take_back_state();
  log_->hold_from(states_->oldest());
  const std::uint64_t before = aligner_.counters().frames;
  // What the state stands for is nowhere but in the samples, for who wants to see it.
  Aligner earlier(
      config_.counts(), files::needed_kinds(config_),
      [this](const Frame& frame) {
        calculated_ = frame;
        calculator_.fill(calculated_);
        observer_->on_recalled(calculated_, nullptr);
      },
      files::aligner_settings(config_));
  const auto into = [](Aligner& aligner) -> SampleLog::Visit {
    return [&aligner](const BlockView* block) {
      block != nullptr ? aligner.push(*block) : aligner.expire();
    };
  };
  recalling_ = true;
  const std::string lost =
      log_->recall(into(aligner_), from, observer_ != nullptr ? into(earlier) : nullptr);
  recalling_ = false;
  health_.incomplete = aligner_.counters().incomplete;  // no news
  const std::uint64_t frames = aligner_.counters().frames;
  if (frames > 0) alarms_.recall(monitor_.channels(), {}, {});
  if (diagnosis_) diagnosis_->repeat();
  count_channels();
  std::string text =
      frames == 0 ? "begins anew" : "goes on behind " + counted(frames, "sample") + " from before";
  if (before > 0) text += ", of which it judges " + std::to_string(frames - before) + " again";
  if (!lost.empty()) text += "; not all that was kept is used: " + lost;
  return text;
}

void UnitPipeline::announce() {
  if (!alarms_.announce()) spdlog::warn("{}: the alarms could not be published", config_.unit);
}

PerformanceRecord UnitPipeline::performance() {
  PerformanceRecord record =
      report::performance_record(config_, performance_.setup(), performance_.total());
  record.interval = monitor_.interval();
  record.source_time_ns = monitor_.source_time_ns();
  record.window_samples = performance_.samples();
  return record;
}

// Not into the journal, whose digests keep what a trend needs.
void UnitPipeline::publish_performance() {
  if (!outputs_.write(performance()) && output_limit_.admit(now_))
    spdlog::warn("{}: the control performance could not be published", config_.unit);
}

// Not into the journal: when a diagnosis is through depends on the machine, not on the data.
void UnitPipeline::publish_diagnosis() {
  const std::optional<DiagnosisOutcome> outcome = diagnosis_->poll(now_);
  if (!outcome) return;
  if (!outcome->problem.empty()) {
    spdlog::warn("{}: the alarms could not be diagnosed: {}", config_.unit, outcome->problem);
    return;
  }
  if (outcome->only_wrote) {
    if (!outcome->folder.empty())
      spdlog::info("{}: the report of the last diagnosis could be written now, in {}", config_.unit,
                   outcome->folder);
    return;
  }
  if (observer_ != nullptr) observer_->on_diagnosis(*outcome);
  spdlog::warn("{}: diagnosed up to interval {}: {}{}", config_.unit, outcome->interval,
               outcome->headline,
               outcome->folder.empty() ? "" : " Report in " + outcome->folder + ".");
  bool written = true;
  for (AlarmRecord& alarm : diagnosis_->diagnosed(*outcome)) {
    written = alarms_.diagnosed(alarm, outcome->interval, outcome->time_ns, wall_ns()) && written;
    alarm.interval = outcome->interval;
    alarm.source_time_ns = outcome->time_ns;
    if (observer_ != nullptr) observer_->on_alarm(alarm, alarm.named.text);
  }
  if (!written && output_limit_.admit(now_))
    spdlog::warn("{}: the diagnosis could not be published completely", config_.unit);
}

CommandReply UnitPipeline::obey(const CommandRecord& record,
                                const std::variant<AlarmCommand, std::string>& admitted) {
  if (const auto* command = std::get_if<AlarmCommand>(&admitted)) return obey(*command);
  AlarmCommand refused;
  refused.mv = printable(record.mv);
  refused.cv = printable(record.cv);
  refused.user = printable(record.user);
  refused.host = printable(record.host);
  refused.comment = printable(record.comment);
  const auto& why = std::get<std::string>(admitted);
  refuse(refused, printable(record.action), why);
  return {false, why};
}

// Nobody knows who it was, and whoever it was may go on for ever.
void UnitPipeline::refuse(const AlarmCommand& command, const std::string& action,
                          const std::string& why) {
  if (!refusal_limit_.admit(now_)) return;
  alarms_.note_refused(command, action, why, wall_ns());
  spdlog::warn("{}: a command of {} on {} was refused: {}", config_.unit,
               command.user.empty() ? "nobody" : command.user,
               command.host.empty() ? "no host" : command.host, why);
}

CommandReply UnitPipeline::obey(const AlarmCommand& command) {
  if (stands_by())
    return {false, "this monitor stands by: give the command to " +
                       (role_->speaker().empty() ? "the one that speaks" : role_->speaker())};
  CommandReply reply = alarms_.apply(command, wall_ns());
  spdlog::info("{}: {} {}: {} ({} on {})", config_.unit,
               command.cv.empty() ? "the controller's alarm" : command.mv + " -> " + command.cv,
               to_string(command.action), reply.text, command.user, command.host);
  return reply;
}

std::int64_t UnitPipeline::wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

void UnitPipeline::share(std::unique_ptr<Role> role, Clock::time_point now) {
  role_ = std::move(role);
  role_begins_ = now;
  outputs_.be_silent(true);
}

void UnitPipeline::say_role(Clock::time_point now) { role_->say(now, wall_ns()); }

void UnitPipeline::settle_role(Clock::time_point now) {
  if (!role_->settle(now, wall_ns())) return;
  outputs_.be_silent(!role_->active());
  other_monitors_.clear();
  next_health_ = now;
  if (!role_->active()) {
    spdlog::warn("{}: stands by; {} speaks", config_.unit, role_->speaker());
    return;
  }
  role_begins_ = now;
  spdlog::info("{}: speaks{}", config_.unit,
               role_->speaker().empty() ? "" : " in place of " + role_->speaker());
  bool written = alarms_.take_over(std::exchange(told_, {}), monitor_.channels(), wall_ns());
  if (aligner_.counters().frames > 0) {
    for (const ChannelRecord& channel : monitor_.channels())
      written = outputs_.write(channel) && written;
    written = outputs_.write(performance()) && written;
  }
  if (!written) spdlog::warn("{}: not all could be said anew", config_.unit);
}

// Whoever writes what is no channel of this unit does not fill the memory.
void UnitPipeline::hear_told(AlarmRecord event) {
  if (!alarms_.has(event.mv, event.cv)) return;
  ToldAlarms::Channel channel{event.mv, event.cv};
  told_.events.insert_or_assign(std::move(channel), std::move(event));
}

void UnitPipeline::hear_told(AlarmStateRecord state) {
  if (!alarms_.has(state.mv, state.cv)) return;
  ToldAlarms::Channel channel{state.mv, state.cv};
  told_.states.insert_or_assign(std::move(channel), std::move(state));
}

void UnitPipeline::hear_other_monitor(std::uint64_t writer, std::string name,
                                      Clock::time_point now) {
  if (stands_by()) return;
  other_monitors_[writer] = {std::move(name), now};
  for (auto other = other_monitors_.begin(); other != other_monitors_.end();)
    other = now - other->second.heard < kOtherMonitorGone ? std::next(other)
                                                          : other_monitors_.erase(other);
}

void UnitPipeline::tick(Clock::time_point now, std::uint64_t unknown_unit,
                        const bus::Surroundings& around) {
  go_on(now);
  if (aligner_.pending() && now - last_frame_ > patience_) {
    if (log_) log_->push_expiry();
    aligner_.expire();
  }
  if (diagnosis_) publish_diagnosis();
  if (now >= next_health_) {
    next_health_ = now + kHealthPeriod;
    if (states_) states_->poll();
    if (!alarms_.tick(wall_ns()) && output_limit_.admit(now_))
      spdlog::warn("{}: the alarms could not be published", config_.unit);
    publish_health(unknown_unit, around);
    publish_alarms_again();
  }
  if (observer_ != nullptr && observer_->wants_view(now)) show();
}

void UnitPipeline::show() {
  observer_->on_view({monitor_.channels(), alarms_.channels(), alarms_.controller(), health_,
                      troubles_, performance(), !stands_by()});
}

void UnitPipeline::publish_health(std::uint64_t unknown_unit, const bus::Surroundings& around) {
  const AlignerCounters& aligner = aligner_.counters();
  health_.frames = aligner.frames;
  health_.used = monitor_.counters().used;
  health_.missing = aligner.missing;
  if (health_.incomplete != aligner.incomplete) incomplete_at_ = now_;
  health_.incomplete = aligner.incomplete;
  health_.late = aligner.late;
  health_.repeated = aligner.repeated;
  health_.out_of_order = aligner.out_of_order;
  health_.bad_values = monitor_.counters().bad_values;
  health_.wrong_length = aligner.wrong_length;
  health_.beyond = aligner.beyond;
  health_.unknown_unit = unknown_unit;
  health_.restarts = aligner.restarts;
  count_channels();
  troubles_ = troubles(around);
  const std::vector<bus::Trouble>& found = troubles_;
  trouble_text_ = bus::joined_text(found, kMostInDetail);
  for (const TroubleLog::Line& line : trouble_log_.update(found, now_, wall_ns() / kSecond))
    spdlog::log(line.begins ? spdlog::level::warn : spdlog::level::info, "{}: {}", config_.unit,
                line.text);
  judge_health(found);
  if (journal_) journal_->push(health_);
  if (!outputs_.write(health_) && output_limit_.admit(now_))
    spdlog::warn("{}: the health could not be published", config_.unit);
}

void UnitPipeline::count_channels() {
  health_.undetermined = health_.matching = health_.mismatching = health_.active_alarms = 0;
  for (const ChannelRecord& channel : monitor_.channels()) {
    if (channel.verdict == Verdict::kMatch)
      ++health_.matching;
    else if (channel.verdict == Verdict::kMismatch)
      ++health_.mismatching;
    else
      ++health_.undetermined;
    if (channel.alarm == AlarmState::kActive) ++health_.active_alarms;
  }
}

std::vector<bus::Trouble> UnitPipeline::troubles(const bus::Surroundings& around) const {
  using bus::Severity;
  std::vector<bus::Trouble> found = inputs_.troubles(around, now_);
  const auto add = [&found](const char* key, Severity severity, std::string text) {
    found.push_back({key, severity, std::move(text)});
  };
  // Where a topic is missing or has gaps or a counter jumped, that is why.
  if (incomplete_at_ &&
      now_ - *incomplete_at_ < samples_or(config_.sample_time_s, 2, kHealthPeriod) &&
      (found.empty() || found.front().severity == Severity::kMaintenanceRequired))
    add("incomplete", Severity::kOutOfSpecification, "data incomplete");
  std::vector<LostSignal> lost = monitor_.monitor().lost();
  std::erase_if(lost, [this](const LostSignal& signal) {  // its topic pauses, which will be told
    const std::optional<Clock::time_point> last = inputs_.stream(signal.kind).last();
    return signal.cause == LossCause::kNoValue && last &&
           now_ - *last > samples_or(config_.sample_time_s, kPause, kHealthPeriod);
  });
  for (bus::Trouble& trouble : lost_troubles(config_, lost, found))
    found.push_back(std::move(trouble));
  if (stood_still_ && now_ - *stood_still_ < kTold) {
    add("standstill", Severity::kOutOfSpecification,
        fmt::format(
            "the monitor itself stood still for {} s: its machine is too busy or was asleep",
            std::chrono::duration_cast<std::chrono::seconds>(stood_still_for_).count()));
    found.back().event = std::to_string(stood_still_->time_since_epoch().count());
  }
  if (other_monitor_speaks())
    add("other monitor", Severity::kMaintenanceRequired, monitors_text(around.self));
  if (role_ && role_->active() && now_ - role_begins_ > kPartnerKnown && !partner(around))
    add("no standby", Severity::kMaintenanceRequired, "no other monitor stands by for this unit");
  if (keys_until_ &&
      wall_ns() / kSecond > *keys_until_ - std::chrono::seconds(keys::kNotice).count())
    add("keys", Severity::kMaintenanceRequired,
        std::string("the keys of this monitor ") +
            (wall_ns() / kSecond > *keys_until_ ? "have expired " : "expire ") +
            files::formatted_utc(*keys_until_, "%Y-%m-%dT%H:%M:%SZ"));
  const auto add_journal = [&](const std::string& which, const std::string& problem) {
    if (!problem.empty())
      add(which.c_str(), Severity::kMaintenanceRequired,
          "the " + which + " cannot be written: " + problem);
  };
  if (journal_) add_journal("journal", journal_->problem());
  if (samples_ != nullptr) add_journal("journal of every sample", samples_->problem());
  if (diagnosis_ && !diagnosis_->file_problem().empty())
    add("reports", Severity::kMaintenanceRequired,
        "reports of diagnoses cannot be kept: " + diagnosis_->file_problem());
  add_journal("journal of alarms", alarms_.journal_problem());
  if (log_) {
    const std::string& problem = log_->problem();
    add_journal("log of samples for a restart", problem.empty() ? states_->problem() : problem);
  }
  sort_by_severity(found);
  return found;
}

bool UnitPipeline::partner(const bus::Surroundings& around) const {
  return std::any_of(around.endpoints.begin(), around.endpoints.end(), [this](const auto& other) {
    return other.writer && other.topic == idl::kRoleTopic && other.user_data == config_.unit;
  });
}

// The worst of what NE 107 has a word for.
void UnitPipeline::judge_health(const std::vector<bus::Trouble>& troubles) {
  const auto set = [this](const char* state, std::string detail) {
    health_.state = state;
    health_.detail = std::move(detail);
  };
  const std::string alarms = counted(health_.active_alarms, "alarm");
  const std::string besides = trouble_text_.empty() ? "" : "; " + trouble_text_;
  const bool in_trouble = !troubles.empty();
  const bool serious =
      in_trouble && troubles.front().severity > bus::Severity::kMaintenanceRequired;
  const bool waiting = health_.frames == 0, alarmed = health_.active_alarms > 0;
  if (serious || (in_trouble && !waiting && !alarmed))
    set(to_string(troubles.front().severity), trouble_text_);
  else if (waiting)
    set("function_check", bus::kNoCompleteData + besides);
  else if (alarmed)
    set("maintenance_required", alarms + besides);
  else if (health_.matching + health_.mismatching == 0)
    set("function_check", bus::kNothingDetermined);
  else
    set("normal", "");
  if (stands_by())
    health_.detail = "stands by" +
                     (role_->speaker().empty() ? "" : "; " + role_->speaker() + " speaks") +
                     (health_.detail.empty() ? "" : "; " + health_.detail);
}

}  // namespace mpm::live
