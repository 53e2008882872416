#include "daemon/live/command_queue.hpp"

#include <algorithm>
#include <utility>

namespace mpm::live {

CommandReply CommandQueue::ask(const AlarmCommand& command) {
  const auto deadline = std::chrono::steady_clock::now() + patience_;
  const auto entry = std::make_shared<Entry>(Entry{command, std::nullopt});
  MutexLock lock(mutex_);
  if (waiting_.size() >= kMostWaiting) return {false, "too many commands wait; try again"};
  waiting_.push_back(entry);
  while (!entry->reply) {
    if (answered_.wait_until(lock, deadline) || entry->reply) continue;
    // Taken already: its answer is a matter of the handler alone.
    if (std::erase(waiting_, entry) == 0) {
      answered_.wait(lock);
      continue;
    }
    return {false, "the monitor is busy and did not take the command; nothing was done"};
  }
  return *entry->reply;
}

void CommandQueue::tell_refused(const AlarmCommand& command, const std::string& why) {
  const MutexLock lock(mutex_);
  if (refused_.size() < kMostWaiting) refused_.emplace_back(command, why);
}

void CommandQueue::serve(
    const std::function<CommandReply(const AlarmCommand&)>& handler,
    const std::function<void(const AlarmCommand&, const std::string&)>& on_refused) {
  std::deque<std::shared_ptr<Entry>> taken;
  std::vector<std::pair<AlarmCommand, std::string>> refused;
  {
    const MutexLock lock(mutex_);
    taken.swap(waiting_);
    refused.swap(refused_);
  }
  for (const auto& [command, why] : refused) on_refused(command, why);
  for (const std::shared_ptr<Entry>& entry : taken) {
    CommandReply reply = handler(entry->command);
    const MutexLock lock(mutex_);
    entry->reply = std::move(reply);
    answered_.notify_all();
  }
}

}  // namespace mpm::live
