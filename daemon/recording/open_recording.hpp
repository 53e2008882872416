#pragma once

#include <memory>
#include <string>

#include "config/unit_config.hpp"
#include "daemon/io/frame_source.hpp"

namespace mpm::recording {

/// The frames of one unit from a data file: MCAP or CSV, told by how it begins. Throws
/// config::InputError where it is neither or does not fit the unit.
[[nodiscard]] std::unique_ptr<io::FrameSource> open_recording(const std::string& path,
                                                              const config::UnitConfig& unit);

}  // namespace mpm::recording
