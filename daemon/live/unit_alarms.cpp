#include "daemon/live/unit_alarms.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/text/number_text.hpp"

namespace mpm::live {
namespace {

std::vector<AlarmDesk::Channel> names_of(const std::vector<ChannelRecord>& channels) {
  std::vector<AlarmDesk::Channel> names;
  names.reserve(channels.size());
  for (const ChannelRecord& channel : channels) names.push_back({channel.mv, channel.cv});
  return names;
}

// Whether the question of the alarm, does the model match the plant, has a meaning now.
bool meaningful(Reason reason) {
  return reason != Reason::kControllerOff && reason != Reason::kBadData;
}

constexpr std::string_view kOver = "over: ", kSilenced = "silenced: ";

// Of what has cleared the text has to say so, `how`; empty: it stands.
std::string told_text(std::string text, std::string_view how) {
  for (const std::string_view before : {kOver, kSilenced})
    if (text.starts_with(before)) text.erase(0, before.size());
  if (!text.empty()) text.insert(0, how);
  return text;
}

// While nothing stands nobody looks at what is suppressed by design each time the controller rests.
bool worth_keeping(const AlarmDesk::Occurrence& occurrence, const AlarmStanding& standing) {
  const bool silence = occurrence.what == AlarmOccurrence::kSuppressed ||
                       occurrence.what == AlarmOccurrence::kUnsuppressed;
  return occurrence.by_command || !silence || standing.annunciation != Annunciation::kNormal;
}

}  // namespace

UnitAlarms::UnitAlarms(const config::UnitConfig& unit, const UnitOutputs& outputs,
                       const std::vector<ChannelRecord>& channels)
    : unit_(unit.unit),
      settings_(unit.alarm_handling.controller),
      outputs_(outputs),
      desk_(unit.alarm_handling, unit.sample_time_s, names_of(channels)),
      observed_(channels.size()),
      fresh_(channels.size() + 1, false),
      said_(channels.size(), false) {
  for (const ChannelRecord& channel : channels) {
    AlarmStateRecord record;
    record.unit = channel.unit;
    record.mv = channel.mv;
    record.cv = channel.cv;
    alarms_.push_back(std::move(record));
  }
  diagnosed_.assign(alarms_.begin(), alarms_.end());
  controller_.unit = unit_;
  controller_.consequence = settings_.consequence;
  controller_.action = settings_.action;
  controller_.time_to_respond_s = settings_.time_to_respond_s;
  controller_.guidance = settings_.guidance;
  controller_.display_url = settings_.display_url;
  controller_.runbook = settings_.runbook;
  for (int i = AlarmDesk::kController; i < desk_.channels(); ++i) refresh(i);
}

bool UnitAlarms::announce() {
  for (std::size_t i = 0; i < alarms_.size(); ++i) said_[i] = alarms_[i].to == AlarmChange::kActive;
  return publish_again(true);
}

void UnitAlarms::keep(AlarmJournal& journal, std::int64_t wall_ns) {
  journal_ = &journal;
  for (const history::AlarmEntry& before : journal.before(unit_))
    if (recalled_ ? desk_.resume(before.mv, before.cv, before.standing)
                  : desk_.restore(before.mv, before.cv, before.standing)) {
      const int alarm = desk_.find(before.mv, before.cv);
      (alarm == AlarmDesk::kController ? controller_.view
                                       : alarms_[static_cast<std::size_t>(alarm)].view)
          .message = before.message;
      refresh(alarm);
    }
  refresh(AlarmDesk::kController);  // the journal may tell of it before its channels
  if (recalled_) {
    stand_unknown(wall_ns);
    clear_unwritten(wall_ns);
  }
  desk_.tick({source_time_ns_, wall_ns});  // what was shelved until a time that has passed
  settle(wall_ns, nullptr);
}

// A journal that was lost silences nothing.
void UnitAlarms::stand_unknown(std::int64_t wall_ns) {
  std::uint64_t count = 0;
  std::int64_t since_ns = source_time_ns_;
  for (int i = 0; i < desk_.channels(); ++i) {
    const AlarmStateRecord& alarm = alarms_[static_cast<std::size_t>(i)];
    if (alarm.to != AlarmChange::kActive || desk_.active(i)) continue;
    stand(i, alarm.source_time_ns, wall_ns);
    since_ns = std::min(since_ns, alarm.source_time_ns);
    ++count;
  }
  if (count == 0) return;
  spdlog::warn("{}: of {} that stand{} the journal says nothing: announced as unacknowledged",
               unit_, counted(count, "alarm"), count == 1 ? "s" : "");
  if (desk_.standing_channels() > 0 && !desk_.active(AlarmDesk::kController))
    stand(AlarmDesk::kController, since_ns, wall_ns);
}

// Samples are on the disk before what the journal says of them.
void UnitAlarms::clear_unwritten(std::int64_t wall_ns) {
  for (int i = 0; i < desk_.channels(); ++i) {
    if (!desk_.active(i) || observed_[static_cast<std::size_t>(i)].active) continue;
    desk_.observe(observed_, {source_time_ns_, wall_ns});
    settle(wall_ns, nullptr);
    return;
  }
}

void UnitAlarms::stand(int alarm, std::int64_t since_ns, std::int64_t wall_ns) {
  AlarmStanding standing = desk_.standing(alarm);
  standing.annunciation = Annunciation::kUnacknowledged;
  standing.active_time_ns = since_ns;
  const bool controller = alarm == AlarmDesk::kController;
  const AlarmDesk::Channel name = controller ? AlarmDesk::Channel{} : desk_.channel(alarm);
  (void)desk_.resume(name.mv, name.cv, standing);
  refresh(alarm);
  journal_->push(entry(alarm, std::string(to_string(AlarmOccurrence::kActive)), wall_ns));
}

AlarmStateRecord* UnitAlarms::find(const std::string& mv, const std::string& cv) {
  const auto it = std::find_if(alarms_.begin(), alarms_.end(),
                               [&](const auto& alarm) { return alarm.mv == mv && alarm.cv == cv; });
  return it == alarms_.end() ? nullptr : &*it;
}

void UnitAlarms::note(const std::vector<ChannelRecord>& channels,
                      const std::vector<AlarmRecord>& changes,
                      const std::vector<std::string>& texts) {
  if (!channels.empty()) {
    interval_ = channels.front().interval;
    source_time_ns_ = channels.front().source_time_ns;
  }
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (AlarmStateRecord* alarm = find(changes[i].mv, changes[i].cv); alarm) {
      std::string text = changes[i].to == AlarmChange::kActive ? texts[i] : alarm->view.message;
      *alarm = AlarmStateRecord(changes[i]);
      alarm->view.message = std::move(text);
      const auto index = static_cast<std::size_t>(alarm - alarms_.data());
      diagnosed_[index].named = {};
      fresh_[index] = true;
    }
}

void UnitAlarms::recall(const std::vector<ChannelRecord>& channels,
                        const std::vector<AlarmRecord>& changes,
                        const std::vector<std::string>& texts) {
  recalled_ = true;
  note(channels, changes, texts);
  for (std::size_t i = 0; i < channels.size(); ++i)
    observed_[i] = {channels[i].alarm == AlarmState::kActive, meaningful(channels[i].reason)};
  fresh_.assign(fresh_.size(), false);  // `announce` tells all
}

void UnitAlarms::archive(Archive& a) {
  // not archived: unit_, settings_, outputs_, journal_ (construction)
  // not archived: desk_, controller_ (`keep` has them from the journal)
  // not archived: observed_, fresh_, said_ (each frame, `recall` and `announce` say them anew)
  a(alarms_, diagnosed_, interval_);
  a.time(source_time_ns_);
  recalled_ = recalled_ || a.reads();
}

bool UnitAlarms::push(const std::vector<ChannelRecord>& channels,
                      const std::vector<AlarmRecord>& changes,
                      const std::vector<std::string>& texts, std::int64_t wall_ns) {
  bool written = true;
  note(channels, changes, texts);
  for (const AlarmRecord& change : changes) written = say(change) && written;
  for (std::size_t i = 0; i < channels.size(); ++i)
    observed_[i] = {channels[i].alarm == AlarmState::kActive, meaningful(channels[i].reason)};
  desk_.observe(observed_, {source_time_ns_, wall_ns});
  return settle(wall_ns, nullptr) && written;
}

bool UnitAlarms::say(const AlarmRecord& change) {
  if (const int alarm = desk_.find(change.mv, change.cv); alarm >= 0 && !outputs_.silent())
    said_[static_cast<std::size_t>(alarm)] = change.to != AlarmChange::kCleared;
  return outputs_.write(change);
}

// The other one may have ended before it found what this one has found of the same alarm.
bool UnitAlarms::say_cause(std::size_t i, const AlarmRecord* told) {
  const AlarmRecord& own = diagnosed_[i];
  AlarmStateRecord& alarm = alarms_[i];
  const bool told_since = told != nullptr && told->to == AlarmChange::kDiagnosed &&
                          told->source_time_ns >= own.source_time_ns;
  if (own.named.text.empty() || own.source_time_ns < alarm.source_time_ns || told_since)
    return true;
  const bool news = alarm.named.text != own.named.text;
  alarm.named = own.named;
  alarm.view.message = own.named.text;
  return !news || outputs_.write(own);
}

bool UnitAlarms::stood(const ToldAlarms& told, std::size_t channel) const {
  const AlarmStateRecord& alarm = alarms_[channel];
  return told.active(alarm.mv, alarm.cv).value_or(said_[channel]);
}

bool UnitAlarms::take_over(const ToldAlarms& told, const std::vector<ChannelRecord>& channels,
                           std::int64_t wall_ns) {
  bool written = true;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    AlarmStateRecord& alarm = alarms_[i];
    const bool before = stood(told, i);
    observed_[i] = {channels[i].alarm == AlarmState::kActive, meaningful(channels[i].reason)};
    const AlarmStateRecord* state = told.state(alarm.mv, alarm.cv);
    if (state != nullptr) {
      const bool active = state->to == AlarmChange::kActive;
      const AlarmStanding standing = standing_of(state->view, active);
      note_acts(static_cast<int>(i), standing, wall_ns);
      (void)desk_.resume(alarm.mv, alarm.cv, standing);
      if (active || !observed_[i].active) alarm = *state;
    }
    const auto event = told.events.find({alarm.mv, alarm.cv});
    if (before && alarm.to != AlarmChange::kActive && event != told.events.end())
      alarm = AlarmStateRecord(event->second);  // it fell silent between the two topics
    if (!before && observed_[i].active)
      written = say(alarm) && written;
    else if (before)
      written = say_cause(i, event == told.events.end() ? nullptr : &event->second) && written;
    said_[i] = observed_[i].active;
  }
  if (told.controller) {
    const AlarmStanding standing =
        standing_of(told.controller->view, told.controller->state == AlarmState::kActive);
    note_acts(AlarmDesk::kController, standing, wall_ns);
    (void)desk_.resume("", "", standing);
    controller_.state = told.controller->state;
    controller_.interval = told.controller->interval;
    controller_.source_time_ns = told.controller->source_time_ns;
    controller_.view.message = told.controller->view.message;
  }
  desk_.observe(observed_, {source_time_ns_, wall_ns});
  fresh_.assign(fresh_.size(), true);
  return settle(wall_ns, nullptr) && written;
}

// What people did where another monitor spoke, for this one's journal.
void UnitAlarms::note_acts(int alarm, const AlarmStanding& told, std::int64_t wall_ns) {
  if (journal_ == nullptr) return;
  const AlarmStanding& own = desk_.standing(alarm);
  const auto note = [&](bool changed, AlarmOccurrence what) {
    if (!changed) return;
    history::AlarmEntry act = entry(alarm, std::string(to_string(what)), wall_ns);
    act.standing = told;
    act.user = told.user;
    act.comment = told.comment;
    journal_->push(std::move(act));
  };
  note(told.ack_time_ns > own.ack_time_ns, AlarmOccurrence::kAcknowledged);
  note(told.shelving != own.shelving, told.shelving == Shelving::kUnshelved
                                          ? AlarmOccurrence::kUnshelved
                                          : AlarmOccurrence::kShelved);
  note(told.suppressed != own.suppressed,
       told.suppressed ? AlarmOccurrence::kSuppressed : AlarmOccurrence::kUnsuppressed);
  note(told.out_of_service != own.out_of_service,
       told.out_of_service ? AlarmOccurrence::kOutOfService : AlarmOccurrence::kInService);
}

bool UnitAlarms::diagnosed(const AlarmRecord& diagnosis, std::int64_t interval,
                           std::int64_t source_time_ns, std::int64_t wall_ns) {
  AlarmStateRecord* alarm = find(diagnosis.mv, diagnosis.cv);
  if (alarm == nullptr) return true;
  AlarmRecord event = diagnosis;
  event.interval = interval;
  event.source_time_ns = source_time_ns;
  const bool news = alarm->view.message != diagnosis.named.text;
  *alarm = AlarmStateRecord(diagnosis);
  alarm->view.message = diagnosis.named.text;
  const int index = static_cast<int>(alarm - alarms_.data());
  diagnosed_[static_cast<std::size_t>(index)] = event;
  refresh(index);
  if (journal_ != nullptr && news) journal_->push(entry(index, "diagnosed", wall_ns));
  const bool written = write(index);
  return outputs_.write(event) && written;
}

bool UnitAlarms::size_known(std::size_t channel, std::string text) {
  alarms_[channel].view.message = std::move(text);
  return write(static_cast<int>(channel));
}

bool UnitAlarms::tick(std::int64_t wall_ns) {
  desk_.tick({source_time_ns_, wall_ns});
  return settle(wall_ns, nullptr);
}

CommandReply UnitAlarms::apply(const AlarmCommand& command, std::int64_t wall_ns) {
  CommandReply reply = desk_.apply(command, {source_time_ns_, wall_ns});
  if (reply.accepted)
    settle(wall_ns, &command);
  else
    note_refused(command, std::string(to_string(command.action)), reply.text, wall_ns);
  return reply;
}

void UnitAlarms::note_refused(const AlarmCommand& command, const std::string& action,
                              const std::string& why, std::int64_t wall_ns) {
  if (journal_ == nullptr) return;
  const int alarm = desk_.find(command.mv, command.cv);
  history::AlarmEntry refused =
      entry(alarm == AlarmDesk::kNone ? AlarmDesk::kController : alarm, "refused", wall_ns);
  refused.mv = command.mv;
  refused.cv = command.cv;
  refused.user = command.user;
  refused.host = command.host;
  refused.comment = command.comment;
  refused.message = action + ": " + why;
  journal_->push(std::move(refused));
}

// What the desk says has occurred: told, written down, published.
bool UnitAlarms::settle(std::int64_t wall_ns, const AlarmCommand* command) {
  for (const AlarmDesk::Occurrence& occurrence : desk_.occurred()) {
    refresh(occurrence.alarm);
    fresh_[occurrence.alarm == AlarmDesk::kController
               ? alarms_.size()
               : static_cast<std::size_t>(occurrence.alarm)] = true;
  }
  if (desk_.occurred().empty() &&
      std::none_of(fresh_.begin(), fresh_.end(), [](bool fresh) { return fresh; }))
    return true;
  for (const AlarmDesk::Occurrence& occurrence : desk_.occurred()) {
    if (journal_ == nullptr || !worth_keeping(occurrence, desk_.standing(occurrence.alarm)))
      continue;
    history::AlarmEntry kept =
        entry(occurrence.alarm, std::string(to_string(occurrence.what)), wall_ns);
    if (command != nullptr && occurrence.by_command) {
      kept.user = command->user;
      kept.host = command->host;
      kept.comment = command->comment;
    }
    journal_->push(std::move(kept));
  }
  bool written = true;
  for (int i = 0; i < desk_.channels(); ++i)
    if (fresh_[static_cast<std::size_t>(i)]) {
      refresh(i);
      written = write(i) && written;
    }
  // Its count of channels may have changed with theirs.
  refresh(AlarmDesk::kController);
  written = write(AlarmDesk::kController) && written;
  fresh_.assign(fresh_.size(), false);
  return written;
}

void UnitAlarms::refresh(int alarm) {
  const AlarmStanding& standing = desk_.standing(alarm);
  if (alarm == AlarmDesk::kController) {
    const bool active = desk_.active(alarm);
    const bool changed = active != (controller_.state == AlarmState::kActive);
    controller_.state = active ? AlarmState::kActive : AlarmState::kCleared;
    if (changed) {
      controller_.interval = interval_;
      controller_.source_time_ns = source_time_ns_;
    }
    // What is silenced is not over.
    const std::string_view how = active ? ""
                                 : silenced_channels() > 0 && desk_.standing_channels() == 0
                                     ? kSilenced
                                     : kOver;
    std::string message =
        told_text(active ? controller_text() : std::move(controller_.view.message), how);
    controller_.view = ControlRoomView(standing, settings_.notification_class, settings_.priority);
    controller_.view.message = std::move(message);
    controller_.channels = desk_.standing_channels();
    return;
  }
  AlarmStateRecord& record = alarms_[static_cast<std::size_t>(alarm)];
  std::string message =
      told_text(std::move(record.view.message), record.to == AlarmChange::kActive ? "" : kOver);
  record.view = ControlRoomView(standing, NotificationClass::kAlert, AlarmPriority::kLow);
  record.view.message = std::move(message);
}

// Which, of the first; how many more. Once all have cleared, and its delay has not passed, the
// last.
std::string UnitAlarms::controller_text() const {
  int count = 0;
  std::string first;
  for (int i = 0; i < desk_.channels(); ++i) {
    if (!desk_.active(i) || desk_.standing(i).silenced()) continue;
    if (++count == 1) first = desk_.channel(i).mv + " -> " + desk_.channel(i).cv;
  }
  if (count == 0) return controller_.view.message;
  return "the model of " + first +
         (count == 1 ? ""
                     : " and " + counted(static_cast<std::uint64_t>(count - 1), "more channel")) +
         (count == 1 ? " does" : " do") + " not match the plant";
}

history::AlarmEntry UnitAlarms::entry(int alarm, std::string what, std::int64_t wall_ns) const {
  history::AlarmEntry entry;
  entry.written_ns = wall_ns;
  entry.source_time_ns = source_time_ns_;
  entry.unit = unit_;
  entry.what = std::move(what);
  entry.standing = desk_.standing(alarm);
  if (alarm == AlarmDesk::kController) {
    entry.notification_class = settings_.notification_class;
    entry.priority = settings_.priority;
    entry.message = controller_.view.message;
  } else {
    const AlarmStateRecord& record = alarms_[static_cast<std::size_t>(alarm)];
    entry.mv = record.mv;
    entry.cv = record.cv;
    entry.message = record.view.message;
  }
  return entry;
}

std::uint32_t UnitAlarms::silenced_channels() const {
  std::uint32_t count = 0;
  for (int i = 0; i < desk_.channels(); ++i)
    if (desk_.active(i) && desk_.standing(i).silenced()) ++count;
  return count;
}

bool UnitAlarms::write(int alarm) {
  return alarm == AlarmDesk::kController ? outputs_.write(controller_)
                                         : outputs_.write(alarms_[static_cast<std::size_t>(alarm)]);
}

bool UnitAlarms::publish_again(bool all) {
  bool written = true;
  for (int i = 0; i < desk_.channels(); ++i)
    if (all || alarms_[static_cast<std::size_t>(i)].to == AlarmChange::kActive)
      written = write(i) && written;
  if (all || controller_.state == AlarmState::kActive)
    written = write(AlarmDesk::kController) && written;
  return written;
}

}  // namespace mpm::live
