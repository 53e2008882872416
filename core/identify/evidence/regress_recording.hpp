#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/identify/fit/recording.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/mismatch/outside_signals.hpp"
#include "core/model/model_spec.hpp"
#include "core/nonlinear/nonlinear_detector.hpp"

namespace mpm {

/// What of a CV's own past a regression knows.
enum class OwnPast {
  kLags,       ///< a loop that swings by itself, as with a sticking valve, is predicted as well by
               ///< slow means of its past as by its input. Each row counts whole, for all that a
               ///< step test says is in a few of them
  kAsMonitor,  ///< slow means too: noise that wanders is predicted from far back, without which
               ///< the nonlinear test, which then goes along, would see what is not there
};

/// The monitor's regression of a recording, and the recording's set-points beside it.
struct RegressedRecording {
  std::unique_ptr<MismatchDetector> detector;    ///< null where there are too few rows
  std::unique_ptr<OutsideSignals> setpoints;     ///< of as many rows; null where there are none
  std::unique_ptr<NonlinearDetector> nonlinear;  ///< null where `OwnPast` has none
};

/// The monitor's regression of a recording's residuals (samples x CVs, measured minus free run, NaN
/// where unknown), all rows counting alike, with ever fewer lags until the rows suffice for it.
/// `model` in channels, with the recording's aux signals as inputs after its own. `remembered`:
/// rows that can be read again; 0 = as many as the monitor would.
[[nodiscard]] RegressedRecording regress_recording(const ModelSpec& model,
                                                   const Recording& recording,
                                                   const Eigen::MatrixXd& residuals,
                                                   Eigen::Index remembered = 0,
                                                   OwnPast past = OwnPast::kLags);

}  // namespace mpm
