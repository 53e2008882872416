#include "daemon/bag/open_recording.hpp"

#include <utility>

#include "daemon/bag/mcap_frames.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/mcap/file_sequence.hpp"

namespace mpm::bag {

std::unique_ptr<files::FrameSource> open_recording(const std::vector<std::string>& paths,
                                                   const config::UnitConfig& unit,
                                                   std::shared_ptr<const files::TimeZone> zone) {
  if (mcap::is_recording(paths)) return std::make_unique<McapFrames>(paths, unit);
  return std::make_unique<files::CsvReader>(paths.front(), unit, std::move(zone));
}

std::unique_ptr<files::FrameSource> open_recording(const std::string& path,
                                                   const config::UnitConfig& unit,
                                                   std::shared_ptr<const files::TimeZone> zone) {
  return open_recording(std::vector{path}, unit, std::move(zone));
}

}  // namespace mpm::bag
