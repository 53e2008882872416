#include "daemon/recording/open_recording.hpp"

#include <utility>

#include "daemon/io/csv_reader.hpp"
#include "daemon/mcap/record_stream.hpp"
#include "daemon/recording/mcap_frames.hpp"

namespace mpm::recording {

std::unique_ptr<io::FrameSource> open_recording(const std::string& path,
                                                const config::UnitConfig& unit,
                                                std::shared_ptr<const io::TimeZone> zone) {
  if (mcap::is_mcap(path) || path.ends_with(".mcap"))
    return std::make_unique<McapFrames>(path, unit);
  return std::make_unique<io::CsvReader>(path, unit, std::move(zone));
}

}  // namespace mpm::recording
