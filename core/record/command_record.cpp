#include "core/record/command_record.hpp"

#include "core/text/netstring.hpp"

namespace mpm {

std::string signed_text(const CommandRecord& command) {
  std::string text;
  for (const std::string& field :
       {command.unit, command.mv, command.cv, command.action, std::to_string(command.duration_s),
        std::string(command.once ? "1" : "0"), command.user, command.host, command.comment,
        command.id, std::to_string(command.time_ns)})
    append_netstring(text, field);
  return text;
}

}  // namespace mpm
