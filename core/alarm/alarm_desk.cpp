#include "core/alarm/alarm_desk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mpm {
namespace {

int samples_of(double seconds, double sample_time_s) {
  const double samples = std::ceil(seconds / sample_time_s);
  return static_cast<int>(std::clamp(samples, 1.0, 0.5 * std::numeric_limits<int>::max()));
}

}  // namespace

AlarmDesk::AlarmDesk(const AlarmHandling& handling, double sample_time_s,
                     std::vector<Channel> channels)
    : handling_(handling),
      names_(std::move(channels)),
      alarms_(names_.size()),
      seen_(names_.size(), false),
      senseless_(names_.size(), 0) {
  // There is trouble or there is none: 0 or 1 stands for a p-value.
  delays_.raise_below = 0.5;
  delays_.clear_above = 0.5;
  delays_.on_delay = samples_of(handling.controller.on_delay_s, sample_time_s);
  delays_.off_delay = samples_of(handling.controller.off_delay_s, sample_time_s);
  occurred_.reserve(4 * (names_.size() + 1));
  fresh_.reserve(4);
}

void AlarmDesk::note(int alarm, bool by_command) {
  for (const AlarmOccurrence what : fresh_) occurred_.push_back({alarm, what, by_command});
  fresh_.clear();
}

void AlarmDesk::observe(const std::vector<Observation>& channels, const AlarmMoment& now) {
  occurred_.clear();
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    const bool was_meaningful = !alarms_[i].standing().suppressed_by_design;
    int& held = senseless_[i];
    held = channels[i].meaningful == was_meaningful ? 0 : held + 1;
    const bool turns = held >= calibration::kSettled;
    if (turns) held = 0;
    alarms_[i].observe(channels[i].active, was_meaningful != turns, now, handling_.managed, fresh_);
    note(static_cast<int>(i), false);
  }
  settle(now, true);
}

void AlarmDesk::tick(const AlarmMoment& now) {
  occurred_.clear();
  for (int i = kController; i < channels(); ++i) {
    of(i).tick(now, handling_.managed, fresh_);
    note(i, false);
  }
  if (!occurred_.empty()) settle(now, false);
}

CommandReply AlarmDesk::apply(const AlarmCommand& command, const AlarmMoment& now) {
  occurred_.clear();
  const int alarm = find(command.mv, command.cv);
  if (alarm == kNone)
    return {false, command.mv.empty() || command.cv.empty()
                       ? "both a manipulated and a controlled variable are needed, or neither"
                       : "this unit has no channel " + command.mv + " -> " + command.cv};
  CommandReply reply = of(alarm).apply(command, now, handling_.managed, fresh_);
  note(alarm, true);
  if (!occurred_.empty()) settle(now, false);
  return reply;
}

bool AlarmDesk::restore(const std::string& mv, const std::string& cv, const AlarmStanding& before) {
  const int alarm = find(mv, cv);
  if (alarm == kNone) return false;
  of(alarm).restore(before, handling_.managed);
  return true;
}

bool AlarmDesk::resume(const std::string& mv, const std::string& cv, const AlarmStanding& before) {
  const int alarm = find(mv, cv);
  if (alarm == kNone) return false;
  of(alarm).resume(before);
  if (alarm == kController && of(alarm).active()) trouble_.set(AlarmState::kActive);
  return true;
}

int AlarmDesk::standing_channels() const {
  return static_cast<int>(std::count_if(alarms_.begin(), alarms_.end(), [](const auto& alarm) {
    return alarm.active() && !alarm.standing().silenced();
  }));
}

bool AlarmDesk::all_seen() const {
  for (std::size_t i = 0; i < alarms_.size(); ++i)
    if (alarms_[i].active() && !alarms_[i].standing().silenced() && !seen_[i]) return false;
  return true;
}

// Where people have silenced all there is, the controller's alarm goes at once; what the plant
// silences for a while leaves it as it is. What it was acknowledged for calls nobody anew when the
// silence ends.
void AlarmDesk::settle(const AlarmMoment& now, bool new_sample) {
  bool any = false, waits = false, meaningful = alarms_.empty();
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    const ManagedAlarm& alarm = alarms_[i];
    seen_[i] = seen_[i] && alarm.active();
    any = any || alarm.active();
    waits = waits || (alarm.active() && alarm.standing().silenced_by_design_alone());
    meaningful = meaningful || !alarm.standing().suppressed_by_design;
  }
  const bool trouble = standing_channels() > 0;
  if (!meaningful || (waits && !trouble)) {
    trouble_.hold();
  } else if (any && !trouble) {
    if (controller_.standing().annunciation == Annunciation::kAcknowledged)
      for (std::size_t i = 0; i < alarms_.size(); ++i) seen_[i] = alarms_[i].active();
    trouble_.set(AlarmState::kCleared);
  } else if (new_sample) {
    trouble_.update(trouble ? 0.0 : 1.0, delays_);
  }
  if (trouble_.state() == AlarmState::kActive && !controller_.active()) {
    if (trouble && all_seen()) controller_.know();
    seen_.assign(seen_.size(), false);
  }
  controller_.observe(trouble_.state() == AlarmState::kActive, meaningful, now, handling_.managed,
                      fresh_);
  note(kController, false);
}

int AlarmDesk::find(const std::string& mv, const std::string& cv) const {
  if (mv.empty() && cv.empty()) return kController;
  const auto it = std::find_if(names_.begin(), names_.end(), [&](const Channel& channel) {
    return channel.mv == mv && channel.cv == cv;
  });
  return it == names_.end() ? kNone : static_cast<int>(it - names_.begin());
}

}  // namespace mpm
