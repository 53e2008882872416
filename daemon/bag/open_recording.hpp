#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/frame_source.hpp"
#include "daemon/files/times/time_style.hpp"

namespace mpm::bag {

/// The frames of one unit from a data file: MCAP or CSV, told by how it begins. Several MCAP files,
/// or a folder of them, are one recording in the order of time; several of which some are CSV
/// follow one another (`FrameSequence`). Local times of a CSV without a zone in `times` are
/// refused. Throws config::InputError where a file is neither or does not fit the unit.
[[nodiscard]] std::unique_ptr<files::FrameSource> open_recording(
    const std::vector<std::string>& paths, const config::UnitConfig& unit,
    const files::TimeStyle& times = {});
[[nodiscard]] std::unique_ptr<files::FrameSource> open_recording(
    const std::string& path, const config::UnitConfig& unit, const files::TimeStyle& times = {});

}  // namespace mpm::bag
