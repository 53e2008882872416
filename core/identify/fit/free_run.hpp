#pragma once

#include <Eigen/Core>

#include "core/identify/fit/simulator.hpp"

namespace mpm {

/// Simulation of one CV on the simulator's recording, driven by the measured inputs alone. Each run
/// begins where its measurements do; where there are several, each is also at its own level: the
/// one at which the run's errors are 0 on average. CV units.
[[nodiscard]] Eigen::VectorXd free_run(Simulator& simulator, const ModelSpec& model, int cv);

/// The same of all CVs, samples x CVs.
[[nodiscard]] Eigen::MatrixXd free_runs(Simulator& simulator, const ModelSpec& model);

}  // namespace mpm
