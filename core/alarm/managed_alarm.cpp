#include "core/alarm/managed_alarm.hpp"

#include <algorithm>

#include "core/text/number_text.hpp"

namespace mpm {
namespace {

using calibration::kNanoseconds;

CommandReply refused(std::string why) { return {false, std::move(why)}; }

}  // namespace

AlarmWord AlarmStanding::word() const {
  if (out_of_service) return AlarmWord::kOutOfService;
  if (is_suppressed()) return AlarmWord::kSuppressed;
  if (shelving != Shelving::kUnshelved) return AlarmWord::kShelved;
  return static_cast<AlarmWord>(annunciation);
}

void ManagedAlarm::observe(bool active, bool meaningful, const AlarmMoment& now,
                           const Settings& settings, Occurrences& occurred) {
  if (standing_.suppressed_by_design == meaningful) {
    const bool before = standing_.is_suppressed();
    standing_.suppressed_by_design = !meaningful;
    if (standing_.is_suppressed() != before)
      occurred.push_back(meaningful ? AlarmOccurrence::kUnsuppressed
                                    : AlarmOccurrence::kSuppressed);
  }
  if (active == active_) return;
  active_ = active;
  if (active) {
    standing_.active_time_ns = now.source_ns;
    standing_.annunciation = next(standing_.annunciation, Stimulus::kRises);
    if (seen_before_) standing_.annunciation = next(standing_.annunciation, Stimulus::kAcknowledge);
    seen_before_ = false;
    occurred.push_back(AlarmOccurrence::kActive);
    return;
  }
  const bool waits = settings.latching && !standing_.silenced();
  standing_.annunciation =
      next(standing_.annunciation, waits ? Stimulus::kReturns : Stimulus::kFades);
  occurred.push_back(AlarmOccurrence::kCleared);
  if (standing_.shelving == Shelving::kOneShot) unshelve(occurred);
}

void ManagedAlarm::tick(const AlarmMoment& now, const Settings& settings, Occurrences& occurred) {
  if (standing_.shelving != Shelving::kUnshelved && now.wall_ns >= standing_.unshelve_time_ns)
    unshelve(occurred);
  if (standing_.annunciation == Annunciation::kAcknowledged && settings.realarm_s > 0.0 &&
      !standing_.silenced() &&
      static_cast<double>(now.wall_ns - standing_.ack_time_ns) >=
          kNanoseconds * settings.realarm_s) {
    standing_.annunciation = next(standing_.annunciation, Stimulus::kReannounce);
    occurred.push_back(AlarmOccurrence::kReannounced);
  }
}

CommandReply ManagedAlarm::apply(const AlarmCommand& command, const AlarmMoment& now,
                                 const Settings& settings, Occurrences& occurred) {
  const std::size_t before = occurred.size();
  const auto set = [&](bool& flag, bool to, AlarmOccurrence occurrence, const char* already) {
    if (flag == to) return refused(already);
    flag = to;
    occurred.push_back(occurrence);
    return CommandReply{true, std::string(to_string(occurrence))};
  };
  CommandReply reply;
  switch (command.action) {
    case AlarmAction::kAcknowledge: {
      const Annunciation after = next(standing_.annunciation, Stimulus::kAcknowledge);
      if (after == standing_.annunciation)
        reply = refused(after == Annunciation::kNormal ? "there is nothing to acknowledge"
                                                       : "it is acknowledged already");
      else {
        standing_.annunciation = after;
        standing_.ack_time_ns = now.wall_ns;
        occurred.push_back(AlarmOccurrence::kAcknowledged);
        reply = {true, "acknowledged"};
      }
      break;
    }
    case AlarmAction::kShelve:
      reply = shelve(command, now, settings, occurred);
      break;
    case AlarmAction::kUnshelve:
      if (standing_.shelving == Shelving::kUnshelved)
        reply = refused("it is not shelved");
      else {
        unshelve(occurred);
        reply = {true, "unshelved"};
      }
      break;
    case AlarmAction::kSuppress:
      reply =
          set(standing_.suppressed, true, AlarmOccurrence::kSuppressed, "it is suppressed already");
      break;
    case AlarmAction::kUnsuppress:
      reply = set(standing_.suppressed, false, AlarmOccurrence::kUnsuppressed,
                  standing_.suppressed_by_design
                      ? "it is suppressed by design: while its question has no meaning"
                      : "it is not suppressed");
      break;
    case AlarmAction::kOutOfService:
      reply = set(standing_.out_of_service, true, AlarmOccurrence::kOutOfService,
                  "it is out of service already");
      break;
    case AlarmAction::kInService:
      reply = set(standing_.out_of_service, false, AlarmOccurrence::kInService,
                  "it is in service already");
      break;
  }
  if (occurred.size() > before) {
    standing_.user = command.user;
    standing_.comment = command.comment;
  }
  return reply;
}

CommandReply ManagedAlarm::shelve(const AlarmCommand& command, const AlarmMoment& now,
                                  const Settings& settings, Occurrences& occurred) {
  double duration_s = command.duration_s;
  if (command.once && duration_s == 0.0) duration_s = settings.max_shelve_s;
  if (!(duration_s > 0.0)) return refused("a time to shelve for is needed, or once");
  if (duration_s > settings.max_shelve_s)
    return refused("it can be shelved for " + duration_text(settings.max_shelve_s) +
                   " at most (max_shelve of the unit file)");
  standing_.shelving = command.once ? Shelving::kOneShot : Shelving::kTimed;
  standing_.unshelve_time_ns = now.wall_ns + static_cast<std::int64_t>(kNanoseconds * duration_s);
  occurred.push_back(AlarmOccurrence::kShelved);
  return {true, command.once
                    ? "shelved until it clears, for " + duration_text(duration_s) + " at most"
                    : "shelved for " + duration_text(duration_s)};
}

void ManagedAlarm::unshelve(Occurrences& occurred) {
  standing_.shelving = Shelving::kUnshelved;
  standing_.unshelve_time_ns = 0;
  occurred.push_back(AlarmOccurrence::kUnshelved);
}

void ManagedAlarm::restore(const AlarmStanding& before, const Settings& settings) {
  const bool unseen = before.annunciation == Annunciation::kUnacknowledged ||
                      before.annunciation == Annunciation::kReturned;
  seen_before_ = before.annunciation == Annunciation::kAcknowledged;
  standing_ = before;
  standing_.annunciation =
      unseen && settings.latching ? Annunciation::kReturned : Annunciation::kNormal;
  standing_.suppressed_by_design = false;
}

void ManagedAlarm::resume(const AlarmStanding& before) {
  standing_ = before;
  active_ = before.annunciation == Annunciation::kUnacknowledged ||
            before.annunciation == Annunciation::kAcknowledged;
}

}  // namespace mpm
