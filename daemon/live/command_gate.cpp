#include "daemon/live/command_gate.hpp"

#include <cstdlib>
#include <utility>

#include "core/text/printable.hpp"

namespace mpm::live {
namespace {

// How far the clocks of two machines may be apart, and how long a proof holds.
constexpr std::int64_t kFreshNs = 60'000'000'000;
constexpr std::size_t kLongestComment = 1000;  // bytes

}  // namespace

std::string CommandGate::refusal(const CommandRecord& record, std::int64_t wall_ns) const {
  if (!token_) return "this monitor takes no commands: mpmd was started without --token-file";
  if (!token_->proves(signed_text(record), record.proof)) return "the token is not the monitor's";
  if (record.time_ns < wall_ns - kFreshNs || record.time_ns > wall_ns + kFreshNs)
    return "the command is too old or of the future: the clocks of the two machines differ";
  if (admitted_.count(record.id) > 0) return "this very command was given before";
  return "";
}

std::variant<AlarmCommand, std::string> CommandGate::admit(const CommandRecord& record,
                                                           std::int64_t wall_ns) {
  if (std::string why = refusal(record, wall_ns); !why.empty()) return why;
  std::erase_if(admitted_, [wall_ns](const auto& one) {
    return one.second < wall_ns - 2 * kFreshNs || one.second > wall_ns + 2 * kFreshNs;
  });
  admitted_[record.id] = record.time_ns;
  const std::optional<AlarmAction> action = from_string<AlarmAction>(record.action);
  if (!action) return "there is no action '" + printable(record.action) + "'";
  if (record.user.empty()) return "user is missing: who does this is to be known later";
  AlarmCommand command;
  command.unit = record.unit;
  command.mv = printable(record.mv);
  command.cv = printable(record.cv);
  command.action = *action;
  command.duration_s = record.duration_s;
  command.once = record.once;
  command.user = printable(record.user);
  command.host = printable(record.host);
  command.comment = printable(record.comment, kLongestComment);
  return command;
}

}  // namespace mpm::live
