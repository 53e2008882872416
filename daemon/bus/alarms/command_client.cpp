#include "daemon/bus/alarms/command_client.hpp"

#include <thread>

#include "idl/wait_set.hpp"

namespace mpm::bus {

CommandClient::CommandClient(const idl::Participant& participant)
    : writer_(participant), replies_(participant, idl::kCommandReplyTopic, idl::command_qos()) {
  wait_set_.attach(replies_.readable());
}

// Both ways: a monitor that takes commands but whose answers would not be heard is not there yet.
bool CommandClient::wait_for_monitor(Clock::time_point deadline,
                                     const std::function<bool()>& stop) {
  while (writer_.matched_readers() == 0 || replies_.matched_writers() == 0) {
    if (stop() || Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(idl::kLongestWait);
  }
  return true;
}

std::optional<CommandReplyRecord> CommandClient::give(const CommandRecord& command,
                                                      Clock::time_point deadline,
                                                      const std::function<bool()>& stop) {
  if (!writer_.write(command)) return std::nullopt;
  std::optional<CommandReplyRecord> reply;
  while (!reply && !stop() && Clock::now() < deadline)
    if (wait_set_.wait(idl::kLongestWait))
      replies_.take([&](const mpm_CommandReply& sample) {
        auto heard = idl::record_of<CommandReplyRecord>(sample);
        if (heard.id == command.id) reply = std::move(heard);
      });
  return reply;
}

}  // namespace mpm::bus
