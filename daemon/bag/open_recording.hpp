#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/io/frame_source.hpp"
#include "daemon/io/time_zone.hpp"

namespace mpm::recording {

/// The frames of one unit from a data file: MCAP or CSV, told by how it begins. Several MCAP files,
/// or a folder of them, are one recording in the order of time. Local times of a CSV are those of
/// `zone`; refused without one. Throws config::InputError where a file is neither or does not fit
/// the unit.
[[nodiscard]] std::unique_ptr<io::FrameSource> open_recording(
    const std::vector<std::string>& paths, const config::UnitConfig& unit,
    std::shared_ptr<const io::TimeZone> zone = nullptr);
[[nodiscard]] std::unique_ptr<io::FrameSource> open_recording(
    const std::string& path, const config::UnitConfig& unit,
    std::shared_ptr<const io::TimeZone> zone = nullptr);

}  // namespace mpm::recording
