#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/identify/fit/whitening.hpp"

namespace mpm {

/// What of another CV's noise may go before a CV's own: the innovations of its residual up to the
/// row before, as they were last and as exponentially weighted means (rows x means). `residual`: 0
/// where unknown, `known`: 1 or 0; `noise`: what makes it white.
///
/// Noise that reaches several CVs, or one through another, moves their inputs by the controller
/// before all of it has come: inputs then go with what is still to come of a CV's noise, and a fit
/// that knows of no more than the CV's own past takes that for an answer to them (Ljung 1999,
/// section 13.4: under feedback a direct fit is right where its noise model is). Innovations, and
/// none beyond three s.d., for what shifts or bends the other CV's residual is no noise: it may be
/// in both CVs, and what is to be found.
[[nodiscard]] Eigen::MatrixXd noise_before(const Eigen::Ref<const Eigen::VectorXd>& residual,
                                           const Eigen::Ref<const Eigen::VectorXd>& known,
                                           const std::vector<Run>& runs, const NoiseModel& noise);

}  // namespace mpm
