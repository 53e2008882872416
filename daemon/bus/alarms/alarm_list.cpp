#include "daemon/bus/alarms/alarm_list.hpp"

#include "idl/output_samples.hpp"
#include "idl/reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::bus {
namespace {

using Clock = std::chrono::steady_clock;
// What a late joiner is told comes at once.
constexpr std::chrono::milliseconds kQuiet{500};
constexpr int kBatch = 256;

}  // namespace

std::vector<const AlarmStateRecord*> AlarmList::standing(const std::string& unit) const {
  std::vector<const AlarmStateRecord*> list;
  for (const auto& [key, alarm] : channels)
    if (alarm.view.retain && (unit.empty() || alarm.unit == unit)) list.push_back(&alarm);
  return list;
}

AlarmList listen_to_alarms(const idl::Participant& participant, Clock::time_point deadline,
                           const std::function<bool()>& stop) {
  idl::Reader<mpm_ControllerAlarm> controllers(participant, idl::kControllerAlarmTopic,
                                               idl::alarm_qos(), kBatch);
  idl::Reader<mpm_Alarm> channels(participant, idl::kAlarmTopic, idl::alarm_qos(), kBatch);
  idl::WaitSet wait_set;
  wait_set.attach(controllers.readable());
  wait_set.attach(channels.readable());
  AlarmList list;
  Clock::time_point last_word = Clock::now();
  while (!stop() && Clock::now() < deadline) {
    if (wait_set.wait(idl::kLongestWait)) {
      last_word = Clock::now();
      controllers.take([&](const mpm_ControllerAlarm& sample) {
        auto record = idl::record_of<ControllerAlarmRecord>(sample);
        list.controllers[record.unit] = std::move(record);
      });
      channels.take([&](const mpm_Alarm& sample) {
        auto record = idl::record_of<AlarmStateRecord>(sample);
        list.channels[{record.unit, record.cv, record.mv}] = std::move(record);
      });
    }
    if (!list.controllers.empty() && Clock::now() - last_word > kQuiet) break;
  }
  return list;
}

}  // namespace mpm::bus
