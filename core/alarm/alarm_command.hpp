#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/text/words.hpp"

namespace mpm {

enum class AlarmAction : std::uint8_t {
  kAcknowledge,
  kShelve,
  kUnshelve,
  kSuppress,
  kUnsuppress,
  kOutOfService,
  kInService,
};

[[nodiscard]] constexpr auto words_of(AlarmAction) {
  return std::array{"acknowledge", "shelve",         "unshelve",  "suppress",
                    "unsuppress",  "out_of_service", "in_service"};
}

/// What somebody wants done with an alarm. `mv` and `cv` empty: that of the whole unit.
struct AlarmCommand {
  std::string unit, mv, cv;
  AlarmAction action = AlarmAction::kAcknowledge;
  double duration_s = 0;  ///< of shelving; 0 = as long as is allowed
  bool once = false;      ///< shelved until the alarm has cleared once
  std::string user, host, comment;
};

struct CommandReply {
  bool accepted = false;
  std::string text;  ///< for a person: what was done, or why not
};

}  // namespace mpm
