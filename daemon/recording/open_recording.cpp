#include "daemon/recording/open_recording.hpp"

#include <algorithm>
#include <utility>

#include "config/finding.hpp"
#include "daemon/io/csv_reader.hpp"
#include "daemon/mcap/file_sequence.hpp"
#include "daemon/recording/mcap_frames.hpp"

namespace mpm::recording {

std::unique_ptr<io::FrameSource> open_recording(const std::vector<std::string>& paths,
                                                const config::UnitConfig& unit,
                                                std::shared_ptr<const io::TimeZone> zone) {
  const auto csv = std::find_if_not(paths.begin(), paths.end(), mcap::is_recording);
  if (csv == paths.end()) return std::make_unique<McapFrames>(paths, unit);
  if (paths.size() > 1)
    throw config::InputError({*csv, 0, 0, config::Severity::kError, "",
                              "is no MCAP file; only those are taken together"});
  return std::make_unique<io::CsvReader>(*csv, unit, std::move(zone));
}

std::unique_ptr<io::FrameSource> open_recording(const std::string& path,
                                                const config::UnitConfig& unit,
                                                std::shared_ptr<const io::TimeZone> zone) {
  return open_recording(std::vector{path}, unit, std::move(zone));
}

}  // namespace mpm::recording
