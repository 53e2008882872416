#pragma once

#include <Eigen/Core>

#include "core/identify/fit/simulator.hpp"

namespace mpm {

/// Simulation of one CV on the simulator's recording, driven by the measured inputs alone, that
/// begins where the measurements do. CV units.
[[nodiscard]] Eigen::VectorXd free_run(Simulator& simulator, const ModelSpec& model, int cv);

/// The same of all CVs, samples x CVs.
[[nodiscard]] Eigen::MatrixXd free_runs(Simulator& simulator, const ModelSpec& model);

}  // namespace mpm
