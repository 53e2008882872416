#pragma once

#include <cstdint>
#include <string>

#include "config/unit_config.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/files/frame_source.hpp"

namespace mpm::files {

/// A data file in memory, on the grid of the control intervals.
struct RecordingFile {
  Recording recording;
  std::int64_t missing = 0;       ///< intervals without a row; a row of NaN stands for each
  std::int64_t out_of_order = 0;  ///< rows whose time did not grow; left out
  std::int64_t bad_values = 0;    ///< of inputs and CVs in the rows that are there
};

/// Reads all frames. What is bad, missing or implausible becomes NaN. Throws config::InputError,
/// naming the file as `name`, where the grid would hold more than memory should (a clock far off
/// makes a gap of years).
[[nodiscard]] RecordingFile read_recording(FrameSource& source, const config::UnitConfig& unit,
                                           const std::string& name);

/// Why no model can be diagnosed on this recording, one line for a person; empty where one can.
/// `needed` rows at least.
[[nodiscard]] std::string recording_problem(const Recording& recording, Eigen::Index needed);

}  // namespace mpm::files
