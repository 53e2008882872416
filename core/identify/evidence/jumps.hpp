#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// Values that were made unknown.
struct JumpTally {
  std::vector<Eigen::Index> inputs, cvs;  ///< how many of each
  [[nodiscard]] Eigen::Index total() const;
};

/// Makes unknown (NaN) what of the inputs and CVs goes far beyond all that the signal has been and
/// is back within two samples, or is absurdly far away for some more, or where no unit of the
/// process is, however long: one such value would be fitted before all others. The monitor's
/// `Screen`, run by run. What stands still stays, for causes are told by it; so do a test signal's
/// pulses, and what only jumps, as a fast process does.
JumpTally leave_out_jumps(Recording& recording);

}  // namespace mpm
