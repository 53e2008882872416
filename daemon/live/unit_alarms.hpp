#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/alarm/alarm_desk.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "daemon/live/alarm_journal.hpp"
#include "daemon/live/told_alarms.hpp"
#include "daemon/live/unit_outputs.hpp"

namespace mpm {
class Archive;
}

namespace mpm::live {

/// The alarms of one unit towards people: what changes, on mpm/alarm_event; what stands, on
/// mpm/alarm and mpm/controller_alarm; what becomes of it, in the journal; what people do about it.
class UnitAlarms {
 public:
  /// `channels`: of the unit, of which nothing was said yet. Nothing is published before
  /// `announce`.
  UnitAlarms(const config::UnitConfig& unit, const UnitOutputs& outputs,
             const std::vector<ChannelRecord>& channels);

  /// As `push`, of a frame that was judged before a restart: nobody is told, and how it stands is
  /// for `keep` and for the next frame to say.
  void recall(const std::vector<ChannelRecord>& channels, const std::vector<AlarmRecord>& changes,
              const std::vector<std::string>& texts);
  /// What frames have made of them; instead of `recall` of these frames.
  void archive(Archive& a);
  /// From now on what happens is kept there. What people did before holds again, and where frames
  /// were recalled so does which alarms stand; one that stands by the frames, and of which the
  /// journal says nothing, stands as if nobody had seen it; one that stands by the journal alone,
  /// whose end was not written any more, clears.
  void keep(AlarmJournal& journal, std::int64_t wall_ns);
  /// How all of them stand, which clears what a daemon before this one left behind. False where it
  /// could not be published.
  bool announce();

  /// After a frame: `channels` in the order of before, the alarms that it changed, and what is
  /// wrong with the channel of each in words. False where something could not be published.
  bool push(const std::vector<ChannelRecord>& channels, const std::vector<AlarmRecord>& changes,
            const std::vector<std::string>& texts, std::int64_t wall_ns);
  /// Whether a channel's alarm stands for who reads: by what another monitor told, and where that
  /// is silent, by what this process, or one before it, said last.
  [[nodiscard]] bool stood(const ToldAlarms& told, std::size_t channel) const;
  /// From now on this process speaks for the unit, of whose alarms readers know `told` from
  /// another. What they know stands as they know it, with what people did about it; of alarms that
  /// stand here alone, and of causes that only this process has found, they are told. `channels`:
  /// as in `push`, in which every alarm that `stood` stands. False as in `push`.
  bool take_over(const ToldAlarms& told, const std::vector<ChannelRecord>& channels,
                 std::int64_t wall_ns);
  /// A cause was named, at that interval; the alarm is as old as it was.
  bool diagnosed(const AlarmRecord& diagnosis, std::int64_t interval, std::int64_t source_time_ns,
                 std::int64_t wall_ns);
  /// How much is wrong with a channel whose alarm was raised before that was known.
  bool size_known(std::size_t channel, std::string text);
  /// What time alone brings. `wall_ns`: UTC.
  bool tick(std::int64_t wall_ns);
  CommandReply apply(const AlarmCommand& command, std::int64_t wall_ns);
  /// For the journal: a command that was refused before it came here. `action`: as it was given,
  /// which may be a word that means nothing.
  void note_refused(const AlarmCommand& command, const std::string& action, const std::string& why,
                    std::int64_t wall_ns);

  /// Anew, for readers that were told otherwise: all, or those that stand.
  bool publish_again(bool all);

  [[nodiscard]] bool has(const std::string& mv, const std::string& cv) const {
    return desk_.find(mv, cv) >= 0;
  }
  [[nodiscard]] const std::vector<AlarmStateRecord>& channels() const { return alarms_; }
  [[nodiscard]] const ControllerAlarmRecord& controller() const { return controller_; }
  /// Channels whose alarm stands, and which somebody or the plant has silenced.
  [[nodiscard]] std::uint32_t silenced_channels() const;
  /// As AlarmJournal::put_aside.
  [[nodiscard]] std::string journal_put_aside() const {
    return journal_ == nullptr ? "" : journal_->put_aside();
  }
  /// Why the journal cannot be written; empty: it can, or there is none.
  [[nodiscard]] std::string journal_problem() const {
    return journal_ == nullptr ? "" : journal_->problem();
  }

 private:
  [[nodiscard]] AlarmStateRecord* find(const std::string& mv, const std::string& cv);
  void note(const std::vector<ChannelRecord>& channels, const std::vector<AlarmRecord>& changes,
            const std::vector<std::string>& texts);
  bool settle(std::int64_t wall_ns, const AlarmCommand* command);
  void stand_unknown(std::int64_t wall_ns);
  void clear_unwritten(std::int64_t wall_ns);
  void stand(int alarm, std::int64_t since_ns, std::int64_t wall_ns);
  void note_acts(int alarm, const AlarmStanding& told, std::int64_t wall_ns);
  bool say(const AlarmRecord& change);
  bool say_cause(std::size_t i, const AlarmRecord* told);
  void refresh(int alarm);
  [[nodiscard]] std::string controller_text() const;
  [[nodiscard]] history::AlarmEntry entry(int alarm, std::string what, std::int64_t wall_ns) const;
  bool write(int alarm);

  const std::string unit_;
  const ControllerAlarmSettings settings_;
  const UnitOutputs& outputs_;
  AlarmDesk desk_;
  std::vector<AlarmStateRecord> alarms_;  // as last written
  ControllerAlarmRecord controller_;      // likewise
  std::vector<AlarmDesk::Observation> observed_;
  std::vector<AlarmRecord> diagnosed_;  // what this process found last of each that stands
  std::vector<bool> fresh_;             // to be written; the controller's last
  std::vector<bool> said_;              // stands for who reads, as this process last said
  std::int64_t interval_ = 0, source_time_ns_ = 0;
  bool recalled_ = false;
  AlarmJournal* journal_ = nullptr;
};

}  // namespace mpm::live
