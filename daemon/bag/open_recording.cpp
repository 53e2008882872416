#include "daemon/recording/open_recording.hpp"

#include <utility>

#include "daemon/io/csv_reader.hpp"
#include "daemon/mcap/file_sequence.hpp"
#include "daemon/recording/mcap_frames.hpp"

namespace mpm::recording {

std::unique_ptr<io::FrameSource> open_recording(const std::vector<std::string>& paths,
                                                const config::UnitConfig& unit,
                                                std::shared_ptr<const io::TimeZone> zone) {
  if (mcap::is_recording(paths)) return std::make_unique<McapFrames>(paths, unit);
  return std::make_unique<io::CsvReader>(paths.front(), unit, std::move(zone));
}

std::unique_ptr<io::FrameSource> open_recording(const std::string& path,
                                                const config::UnitConfig& unit,
                                                std::shared_ptr<const io::TimeZone> zone) {
  return open_recording(std::vector{path}, unit, std::move(zone));
}

}  // namespace mpm::recording
