#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

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
  /// In the event loop: answers all that waits.
  void serve(const std::function<CommandReply(const AlarmCommand&)>& handler);

 private:
  struct Entry {
    AlarmCommand command;
    std::optional<CommandReply> reply;
  };

  std::chrono::milliseconds patience_;
  Mutex mutex_;
  ConditionVariable answered_;
  std::deque<std::shared_ptr<Entry>> waiting_ MPM_GUARDED_BY(mutex_);
};

}  // namespace mpm::live
