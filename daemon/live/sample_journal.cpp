#include "daemon/live/sample_journal.hpp"

#include <cerrno>
#include <system_error>

#include "daemon/report/record_json.hpp"

namespace mpm::live {

SampleJournal::SampleJournal(const std::string& path) : file_(std::fopen(path.c_str(), "ae")) {
  if (!file_) throw std::system_error(errno, std::generic_category(), path);
}

bool SampleJournal::write(const std::vector<ChannelRecord>& channels,
                          const std::vector<AlarmRecord>& alarms) {
  lines_.clear();
  for (const ChannelRecord& record : channels)
    lines_.append(report::json_text(report::json_of(record))).append("\n");
  for (const AlarmRecord& record : alarms)
    lines_.append(report::json_text(report::json_of(record))).append("\n");
  const bool written = std::fwrite(lines_.data(), 1, lines_.size(), file_.get()) == lines_.size();
  if (std::fflush(file_.get()) == 0 && written)
    problem_.clear();
  else
    problem_ = std::generic_category().message(errno);
  return problem_.empty();
}

}  // namespace mpm::live
