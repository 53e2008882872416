#include "daemon/bag/open_recording.hpp"

#include <algorithm>

#include "daemon/bag/frame_sequence.hpp"
#include "daemon/bag/mcap_frames.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/mcap/read/file_sequence.hpp"

namespace mpm::bag {

std::unique_ptr<files::FrameSource> open_recording(const std::vector<std::string>& paths,
                                                   const config::UnitConfig& unit,
                                                   const files::TimeStyle& times) {
  const auto of_mcap = [](const std::string& path) { return mcap::is_recording(path); };
  if (std::all_of(paths.begin(), paths.end(), of_mcap))
    return std::make_unique<McapFrames>(paths, unit);
  if (paths.size() > 1) return std::make_unique<FrameSequence>(paths, unit, times);
  return std::make_unique<files::CsvReader>(paths.front(), unit, times);
}

std::unique_ptr<files::FrameSource> open_recording(const std::string& path,
                                                   const config::UnitConfig& unit,
                                                   const files::TimeStyle& times) {
  return open_recording(std::vector{path}, unit, times);
}

}  // namespace mpm::bag
