#include "daemon/live/unit_pipeline.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/signal/nanoseconds.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/aligning.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/keys/check_keys.hpp"
#include "daemon/live/unit_samples.hpp"
#include "daemon/report/channel_text.hpp"
#include "daemon/report/unit_performance.hpp"
#include "idl/topics.hpp"

namespace mpm::live {
namespace {

constexpr std::chrono::seconds kHealthPeriod{1};
// Lines a minute of what health tells besides, and of what it does not.
constexpr int kMostOfToldLines = 1;
constexpr int kMostLines = 3;
// Of those without the token, to be kept: enough to see who tries, too few to fill a journal.
constexpr int kMostRefusals = 60;
constexpr std::chrono::minutes kRefusalPeriod{1};

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

std::string others_text(const host::RateLimiter& limit) {
  return limit.held_back() == 0 ? ""
                                : fmt::format(" ({} more like this before)", limit.held_back());
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
      rules_(config),
      calculated_(config.counts()),
      aligner_(
          config.counts(), files::needed_kinds(config),
          [this](const Frame& frame) {
            calculated_ = frame;
            rules_.apply(calculated_);
            recalling_ ? recall_frame(calculated_) : on_frame(calculated_);
          },
          files::aligner_settings(config)),
      patience_(files::frame_patience(config)),
      health_(config_, now),
      neighbours_(config.unit),
      now_(now),
      last_frame_(now),
      next_health_(now),
      refused_limit_(kMostOfToldLines),
      beyond_limit_(kMostOfToldLines),
      restart_limit_(kMostLines),
      refusal_limit_(kMostRefusals, kRefusalPeriod) {
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

void UnitPipeline::push(const idl::SampleView& sample, Clock::time_point now) {
  go_on(now);
  if (!aligner_.pending()) last_frame_ = now;  // patience counts from here
  health_.push(sample, wall_ns());
  if (absence_ && !absence_->until_ns) absence_->until_ns = sample.source_time_ns;
  const AlignerCounters before = aligner_.counters();
  const BlockView block{sample.kind, sample.interval, sample.source_time_ns, sample.values,
                        sample.quality};
  if (checkpoints_ && fits(block, config_.counts())) checkpoints_->push(block);
  aligner_.push(block);
  report(sample, before);
}

// Samples may be the first that is seen after a standstill, and are not to be blamed for it.
void UnitPipeline::go_on(Clock::time_point now) {
  health_.go_on(now);
  now_ = now;
}

// What the aligner has made of it that a person should know.
void UnitPipeline::report(const idl::SampleView& sample, const AlignerCounters& before) {
  const AlignerCounters& after = aligner_.counters();
  if (after.wrong_length != before.wrong_length && refused_limit_.admit(now_))
    spdlog::warn(
        "{}: {} sample of interval {} has {} values and {} qualities, expected {}; ignored{}",
        config_.unit, idl::sample_topic(sample.kind), sample.interval, sample.values.size(),
        sample.quality.size(), config_.counts().of(sample.kind), others_text(refused_limit_));
  if (after.beyond != before.beyond && beyond_limit_.admit(now_))
    spdlog::warn("{}: {} sample of interval {}: numbers beyond 2^53 are not taken; ignored{}",
                 config_.unit, idl::sample_topic(sample.kind), sample.interval,
                 others_text(beyond_limit_));
  report_restart(before);
}

void UnitPipeline::report_restart(const AlignerCounters& before) {
  if (aligner_.counters().restarts == before.restarts || !restart_limit_.admit(now_)) return;
  const auto [from, to] = aligner_.restart();
  spdlog::info("{}: the controller restarted: interval {} after {}{}", config_.unit, to, from,
               others_text(restart_limit_));
}

// Frames that were begun before it may still come first.
void UnitPipeline::note_absence(const Frame& frame) {
  if (!absence_->until_ns || frame.source_time_ns < *absence_->until_ns) return;
  const std::uint64_t missing = aligner_.counters().missing - absence_->missing;
  if (missing > 0) health_.missed(missing, absence_->from_ns, frame.source_time_ns);
  absence_.reset();
}

void UnitPipeline::on_frame(const Frame& frame) {
  last_frame_ = now_;
  if (absence_) note_absence(frame);
  health_.move_to(frame.interval, frame.source_time_ns);
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
  written = tell_sizes() && written;
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

// An alarm is raised when it is sure that something is wrong, which may be before it is known how
// much.
bool UnitPipeline::tell_sizes() {
  bool written = true;
  const std::vector<ChannelRecord>& channels = monitor_.channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const AlarmStateRecord& alarm = alarms_.channels()[i];
    if (alarm.to != AlarmChange::kActive || !report::leaves_size_open(alarm.view.message)) continue;
    AlarmRecord now = alarm;
    static_cast<AlarmEvidence&>(now) = channels[i];
    std::string text = report::error_text(now, modelled_channel(config_, channels, now));
    if (!report::leaves_size_open(text))
      written = alarms_.size_known(i, std::move(text)) && written;
  }
  return written;
}

// A diagnosis that was due then is made again, for the causes that alarms were given are nowhere
// else: only the last of them is left when the unit goes on.
void UnitPipeline::recall_frame(const Frame& frame) {
  health_.move_to(frame.interval, frame.source_time_ns);
  monitor_.push(frame);
  (void)performance_.push(frame, monitor_.monitor().judged());
  if (!monitor_.alarms().empty())
    alarms_.recall(monitor_.channels(), monitor_.alarms(), alarm_texts());
  if (observer_ != nullptr) observer_->on_recalled(frame, &monitor_);
  if (diagnosis_) diagnosis_->push(frame, monitor_.alarms());
}

// All that the samples have made, as far as what is said of them depends on it.
void UnitPipeline::archive(Archive& a) {
  // not archived: config_, outputs_, rules_, patience_, observer_ (construction)
  // not archived: samples_, journal_, checkpoints_ (the disk)
  // not archived: recalling_, calculated_ (empty between calls)
  // not archived: absence_ (before this process)
  // not archived: health_ (made of the others, and of what is around this process)
  // not archived: now_, last_frame_, next_health_, refused_limit_, beyond_limit_, output_limit_,
  // restart_limit_, refusal_limit_ (the clock)
  // not archived: neighbours_, told_, keys_until_ (what is around this process)
  a(aligner_, monitor_, performance_, alarms_);
  if (diagnosis_) a(*diagnosis_);
}

std::string UnitPipeline::recall(const UnitSamples& samples, const std::function<bool()>& stop) {
  checkpoints_.emplace(samples, config_.unit, [this](Archive& a) { archive(a); });
  if (checkpoints_->take_back()) {
    health_.move_to(monitor_.interval(), monitor_.source_time_ns());
    if (diagnosis_) diagnosis_->resume(alarms_.channels());
  }
  const std::uint64_t before = aligner_.counters().frames;
  // What the state stands for is nowhere but in the samples, for who wants to see it.
  Aligner earlier(
      config_.counts(), files::needed_kinds(config_),
      [this](const Frame& frame) {
        calculated_ = frame;
        rules_.apply(calculated_);
        observer_->on_recalled(calculated_, nullptr);
      },
      files::aligner_settings(config_));
  const auto into = [&stop](Aligner& aligner) -> SampleLog::Visit {
    return [&aligner, &stop](const BlockView* block) {
      if (stop && stop()) throw RecallStopped();
      block != nullptr ? aligner.push(*block) : aligner.expire();
    };
  };
  recalling_ = true;
  checkpoints_->recall(into(aligner_), observer_ != nullptr ? into(earlier) : nullptr);
  recalling_ = false;
  health_.recall(aligner_.counters());
  if (aligner_.counters().frames > 0)
    absence_ = Absence{aligner_.counters().missing, health_.record().source_time_ns, std::nullopt};
  const std::uint64_t frames = aligner_.counters().frames;
  if (frames > 0) alarms_.recall(monitor_.channels(), {}, {});
  if (diagnosis_) diagnosis_->repeat();
  health_.count(monitor_.channels());
  if (frames > before) checkpoints_->keep_now();
  std::string text =
      frames == 0 ? "begins anew" : "goes on behind " + counted(frames, "sample") + " from before";
  if (before > 0) text += ", of which it judges " + std::to_string(frames - before) + " again";
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
    return {false,
            "this monitor stands by: give the command to " +
                (neighbours_.speaker().empty() ? "the one that speaks" : neighbours_.speaker())};
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
  neighbours_.share(std::move(role), now);
  outputs_.be_silent(true);
}

void UnitPipeline::settle_role(Clock::time_point now) {
  if (!neighbours_.settle(now, wall_ns())) return;
  outputs_.be_silent(neighbours_.stands_by());
  next_health_ = now;
  const std::string speaker = neighbours_.speaker();
  if (neighbours_.stands_by()) {
    spdlog::warn("{}: stands by; {} speaks", config_.unit, speaker);
    return;
  }
  spdlog::info("{}: speaks{}", config_.unit, speaker.empty() ? "" : " in place of " + speaker);
  const ToldAlarms told = std::exchange(told_, {});
  const std::size_t channels = monitor_.channels().size();
  for (std::size_t i = 0; i < channels; ++i)
    if (alarms_.stood(told, i)) monitor_.stand(i);
  bool written = alarms_.take_over(told, monitor_.channels(), wall_ns());
  if (checkpoints_) checkpoints_->want_state();  // what was told is in no sample
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

void UnitPipeline::tick(Clock::time_point now, std::uint64_t unknown_unit,
                        const bus::Surroundings& around) {
  go_on(now);
  if (aligner_.pending() && now - last_frame_ > patience_) {
    const AlignerCounters before = aligner_.counters();
    if (checkpoints_) checkpoints_->push_expiry();
    aligner_.expire();
    report_restart(before);
  }
  if (diagnosis_) publish_diagnosis();
  if (now >= next_health_) {
    next_health_ = now + kHealthPeriod;
    if (checkpoints_) checkpoints_->poll();
    if (!alarms_.tick(wall_ns()) && output_limit_.admit(now_))
      spdlog::warn("{}: the alarms could not be published", config_.unit);
    publish_health(unknown_unit, around);
    publish_alarms_again();
  }
  if (observer_ != nullptr && observer_->wants_view(now)) show();
}

// What another monitor said meanwhile may be what readers know.
void UnitPipeline::publish_alarms_again() {
  const std::optional<bool> all = neighbours_.to_say_again(now_);
  if (all && !alarms_.publish_again(*all) && output_limit_.admit(now_))
    spdlog::warn("{}: the alarms could not be published anew", config_.unit);
}

// All of one moment: what is wrong is looked for once a second.
void UnitPipeline::show() {
  health_.count(aligner_.counters(), monitor_);
  observer_->on_view({monitor_.channels(), alarms_.channels(), alarms_.controller(),
                      health_.record(), health_.troubles(), performance(), !stands_by()});
}

void UnitPipeline::publish_health(std::uint64_t unknown_unit, const bus::Surroundings& around) {
  std::vector<bus::Trouble> others = neighbours_.troubles(around, now_);
  for (bus::Trouble& trouble : keeping_troubles()) others.push_back(std::move(trouble));
  const HealthRecord& health =
      health_.judge({aligner_.counters(), monitor_, unknown_unit, around, std::move(others),
                     stands_by_text(), alarms_.silenced_channels()},
                    wall_ns() / kSecondNs);
  if (journal_) journal_->push(health);
  if (!outputs_.write(health) && output_limit_.admit(now_))
    spdlog::warn("{}: the health could not be published", config_.unit);
}

std::string UnitPipeline::stands_by_text() const {
  if (!stands_by()) return "";
  const std::string speaker = neighbours_.speaker();
  return "stands by" + (speaker.empty() ? "" : "; " + speaker + " speaks");
}

// What this process cannot keep, and how long it may go on.
std::vector<bus::Trouble> UnitPipeline::keeping_troubles() const {
  using bus::Severity;
  std::vector<bus::Trouble> found;
  const auto add = [&found](const std::string& key, std::string text) {
    found.push_back({key, Severity::kMaintenanceRequired, std::move(text)});
  };
  const auto add_file = [&add](const std::string& which, const std::string& problem) {
    if (!problem.empty()) add(which, "the " + which + " cannot be written: " + problem);
  };
  const std::int64_t now_s = wall_ns() / kSecondNs;
  if (keys_until_ && now_s > *keys_until_ - std::chrono::seconds(keys::kNotice).count())
    add("keys", std::string("the keys of this monitor ") +
                    (now_s > *keys_until_ ? "have expired " : "expire ") +
                    files::formatted_utc(*keys_until_, "%Y-%m-%dT%H:%M:%SZ"));
  if (journal_) add_file("journal", journal_->problem());
  if (samples_ != nullptr) add_file("journal of every sample", samples_->problem());
  if (diagnosis_ && !diagnosis_->file_problem().empty())
    add("reports", "reports of diagnoses cannot be kept: " + diagnosis_->file_problem());
  add_file("journal of alarms", alarms_.journal_problem());
  if (const std::string aside = alarms_.journal_put_aside(); !aside.empty())
    add("journal of alarms put aside", aside);
  if (checkpoints_) add_file("log of samples for a restart", checkpoints_->problem());
  return found;
}

}  // namespace mpm::live
