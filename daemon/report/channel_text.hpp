#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"

/// What is said of a channel in words, the same wherever people read it.
namespace mpm::report {

/// What a unit file knows of a channel besides.
struct ChannelFile {
  bool modelled = true;  ///< the model has it: a gain error in per cent of it means something
  double integrating_gain = 0.0;  ///< its gain, per s, where it integrates; else 0
  std::string mv_unit, cv_unit;
  double sample_time_s = 0.0;                           ///< 0 = not known
  double gain_limit = calibration::materiality::kGain;  ///< errors up to it do not matter, relative
  std::vector<std::string> disturbances;  ///< inputs that are measured and that nobody can move
};
[[nodiscard]] ChannelFile channel_file(const config::UnitConfig& unit, const std::string& mv,
                                       const std::string& cv);

/// Of a mismatch: "gain +41 % (31 to 51; +0.0404 t/h per %), time constant ok, dead time not
/// known", which is what the data do not resolve; `ok` is, beside what is off, what its 95 %
/// interval holds to be as modelled, and nothing much else.
[[nodiscard]] std::string mismatch_text(const ChannelRecord& channel, const ChannelFile& file);

/// How a channel answers as no linear one does; empty unless it does.
[[nodiscard]] std::string nonlinear_text(const ChannelRecord& channel);

/// Of what is undetermined: why, and what would help.
[[nodiscard]] std::string undetermined_text(const ChannelRecord& channel, const ChannelFile& file);

/// Of an alarm, what is wrong with its channel: "gain +41 %", or where the gain is not or may not
/// be wrong "time constant +50 %" or "dead time +12 s", whichever is. `channel`: null where it is
/// not known, or the model lacks it.
[[nodiscard]] std::string error_text(const AlarmRecord& alarm, const ChannelRecord* channel);
/// Whether a text of `error_text` leaves open how much that is.
[[nodiscard]] bool leaves_size_open(const std::string& text);

}  // namespace mpm::report
