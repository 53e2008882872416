#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/history/digest.hpp"

namespace mpm::history {

/// A change of a channel's alarm, of what a journal says of it.
struct AlarmChangeNote {
  std::string mv, cv;
  bool active = false;
  std::int64_t time_ns = 0;
};

/// What a journal holds, in its order.
struct JournalReader {
  std::function<void(UnitHead)> head;
  std::function<void(Digest)> digest;
  std::function<void(AlarmChangeNote)> alarm;
};

/// The files of one unit's journal in the order of their time. `paths`: files, and folders of which
/// all journal files are taken. `unit`: whose, where they hold several; may be empty. Throws
/// config::InputError where there are none, or where it is not clear whose.
[[nodiscard]] std::vector<std::string> journal_of(const std::vector<std::string>& paths,
                                                  const std::string& unit);

/// Reads one file. A last line that has no end was being written when its writer was killed, and is
/// left out. Throws config::InputError (`file:line:col: message`) where any other line is none of a
/// journal.
void read_journal(const std::string& path, const JournalReader& reader);

}  // namespace mpm::history
