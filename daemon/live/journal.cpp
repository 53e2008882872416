#include "daemon/live/journal.hpp"

#include <cerrno>
#include <system_error>

namespace mpm::live {

Journal::Journal(const std::string& path) : file_(std::fopen(path.c_str(), "ae")) {
  if (!file_) throw std::system_error(errno, std::generic_category(), path);
}

bool Journal::write(const std::vector<report::ChannelRecord>& channels,
                    const std::vector<report::AlarmRecord>& alarms) {
  lines_.clear();
  for (const report::ChannelRecord& record : channels)
    lines_.append(to_json(record).dump()).append("\n");
  for (const report::AlarmRecord& record : alarms)
    lines_.append(to_json(record).dump()).append("\n");
  const bool written = std::fwrite(lines_.data(), 1, lines_.size(), file_.get()) == lines_.size();
  return std::fflush(file_.get()) == 0 && written;
}

}  // namespace mpm::live
