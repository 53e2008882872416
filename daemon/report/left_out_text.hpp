#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/read_recording.hpp"

namespace mpm::report {

/// What `files::leave_out_unusable` left out, a sentence each: "1 value left out, far beyond all
/// that the signal is otherwise, of y3 (1)".
[[nodiscard]] std::vector<std::string> left_out_texts(const config::UnitConfig& unit,
                                                      const files::RecordingFile& file);

}  // namespace mpm::report
