#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/alarm/alarm_command.hpp"
#include "core/parallel/mutex.hpp"
#include "idl/condition_variable.hpp"

namespace mpm::live {

/// Commands on their way from any thread to the event loop, and the replies on their way back.
class CommandQueue {
 public:
  /// More that wait are refused: an operator gives one at a time.
  static constexpr std::size_t kMostWaiting = 32;
  /// The loop turns five times a second; longer, and nobody waits for the answer any more.
  static constexpr std::chrono::milliseconds kPatience{2000};

  explicit CommandQueue(std::chrono::milliseconds patience = kPatience) : patience_(patience) {}

  /// Waits until the loop has answered; what it has not taken by then is never carried out.
  [[nodiscard]] CommandReply ask(const AlarmCommand& command);
  /// Of who may not give it: to be kept, and nobody waits. Of many some are lost.
  void tell_refused(const AlarmCommand& command, const std::string& why);
  /// In the event loop: answers all that waits, and hands on what was refused.
  void serve(const std::function<CommandReply(const AlarmCommand&)>& handler,
             const std::function<void(const AlarmCommand&, const std::string&)>& on_refused);

 private:
  struct Entry {
    AlarmCommand command;
    std::optional<CommandReply> reply;
  };

  std::chrono::milliseconds patience_;
  Mutex mutex_;
  ConditionVariable answered_;
  std::deque<std::shared_ptr<Entry>> waiting_ MPM_GUARDED_BY(mutex_);
  std::vector<std::pair<AlarmCommand, std::string>> refused_ MPM_GUARDED_BY(mutex_);
};

}  // namespace mpm::live
