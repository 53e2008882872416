#pragma once

#include <array>
#include <string>

#include "core/text/words.hpp"

namespace mpm {

/// What a person may do to an alarm: silence it in one of three ways, and end that.
enum class AlarmAction : unsigned char {
  kAcknowledge,
  kShelve,  ///< not now: for a time, or until it clears
  kUnshelve,
  kSuppress,  ///< it means nothing in this state of the plant
  kUnsuppress,
  kOutOfService,  ///< maintenance
  kInService,
};
[[nodiscard]] constexpr auto words_of(AlarmAction) {
  return std::array{"acknowledge", "shelve",         "unshelve",  "suppress",
                    "unsuppress",  "out_of_service", "in_service"};
}

struct AlarmCommand {
  std::string unit;
  std::string mv, cv;  ///< tags of a channel; both empty: the controller's alarm
  AlarmAction action = AlarmAction::kAcknowledge;
  double duration_s = 0.0;  ///< to shelve for
  bool once = false;        ///< to shelve until the alarm clears, and for duration_s at most
  std::string user, host, comment;
};

struct CommandReply {
  bool accepted = false;
  std::string text;  ///< what was done, or why not, for a person
};

}  // namespace mpm
