#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "core/record/command_record.hpp"
#include "idl/output_writers.hpp"
#include "idl/reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::bus {

/// Gives commands to monitors and waits for their answers.
class CommandClient {
 public:
  using Clock = std::chrono::steady_clock;

  explicit CommandClient(const idl::Participant& participant);

  /// Waits until somebody takes commands; false where nobody does by `deadline`, or `stop` says so.
  [[nodiscard]] bool wait_for_monitor(Clock::time_point deadline,
                                      const std::function<bool()>& stop);
  /// The answer; none by `deadline`, or `stop` says so.
  [[nodiscard]] std::optional<CommandReplyRecord> give(const CommandRecord& command,
                                                       Clock::time_point deadline,
                                                       const std::function<bool()>& stop);

 private:
  idl::OutputWriter<CommandRecord> writer_;
  idl::Reader<mpm_CommandReply> replies_;
  idl::WaitSet wait_set_;
};

}  // namespace mpm::bus
