#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "core/alarm/alarm_command.hpp"
#include "core/record/command_record.hpp"
#include "daemon/host/command_token.hpp"

namespace mpm::live {

/// Who may give commands: those who prove that they know the token, each proof once, and only while
/// it is fresh.
class CommandGate {
 public:
  /// Without a token nobody may.
  explicit CommandGate(std::optional<host::CommandToken> token) : token_(std::move(token)) {}

  /// The command, or why not. `wall_ns`: UTC.
  [[nodiscard]] std::variant<AlarmCommand, std::string> admit(const CommandRecord& record,
                                                              std::int64_t wall_ns);

 private:
  [[nodiscard]] std::string refusal(const CommandRecord& record, std::int64_t wall_ns) const;

  std::optional<host::CommandToken> token_;
  std::map<std::string, std::int64_t> admitted_;  // when each, as long as it would be fresh
};

}  // namespace mpm::live
