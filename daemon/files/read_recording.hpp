#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identify/evidence/jumps.hpp"
#include "core/identify/fit/recording.hpp"
#include "daemon/files/frame_source.hpp"
#include "daemon/files/times/time_choice.hpp"

namespace mpm::files {

/// A data file in memory, on the grid of the control intervals.
struct RecordingFile {
  Recording recording;
  std::int64_t missing = 0;       ///< intervals without a row; a row of NaN stands for each
  std::int64_t out_of_order = 0;  ///< rows whose time did not grow; left out
  std::int64_t bad_values = 0;    ///< of inputs and CVs in the rows that are there
  std::vector<std::pair<std::string, std::uint64_t>> bad_tags;  ///< whose they are
  JumpTally jumps;               ///< values left out because no process gives them
  std::int64_t long_gaps = 0;    ///< after each a new run begins
  std::int64_t longest_gap = 0;  ///< intervals that a run goes on across
  std::int64_t lost = 0;         ///< rows left out, in which an input was lost (likewise)
  std::int64_t scraps = 0;       ///< rows of runs too short to tell anything; left out
};

/// Leaves out of `file.recording` the values that no process gives, the rows in which an input was
/// lost and the runs that are too short to tell anything, and counts them.
void leave_out_unusable(RecordingFile& file);

/// Reads all frames that `choice` takes. What is bad, missing or implausible becomes NaN. A new run
/// begins where frames were not taken, and after a gap in which a run would forget more of its past
/// than it keeps (longest_gap()) or an input was lost (without_lost_inputs()). Throws
/// config::InputError, naming the file as `name`, where nothing is taken or the file spans more
/// than memory should hold (a clock far off makes a gap of years).
[[nodiscard]] RecordingFile read_recording(FrameSource& source, const config::UnitConfig& unit,
                                           const std::string& name, const TimeChoice& choice = {});

/// Why the unit's model cannot be diagnosed on this recording, one line for a person; empty where
/// it can. `needed` rows at least.
[[nodiscard]] std::string recording_problem(const Recording& recording,
                                            const config::UnitConfig& unit, Eigen::Index needed);

}  // namespace mpm::files
