#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "sim/plant/plant.hpp"

namespace mpm::sim {

/// Whether any offset-free controller that knows only `model` gains can hold a plant with `plant`
/// gains. Its steady state is an iteration u += c pinv(K_model) (r - y), stable for some c > 0 only
/// if every eigenvalue of K_plant pinv(K_model) on the directions that the controller can reach has
/// a positive real part (Garcia and Morari 1985, theorem on integral stabilisability). For square
/// plants the sign of the determinant must therefore survive.
struct GainAgreement {
  double smallest_real_part = 1.0;
  std::optional<double> model_determinant, plant_determinant;  ///< square plants only

  [[nodiscard]] bool stabilisable(double margin = 0.0) const { return smallest_real_part > margin; }
};

/// Gains are CVs x MVs; `cv_weights` (empty = 1) tell what a controller with more CVs than MVs
/// gives up.
[[nodiscard]] GainAgreement compare_gains(const Eigen::MatrixXd& model,
                                          const Eigen::MatrixXd& plant,
                                          const std::vector<double>& cv_weights);

/// Why the plant's stages cannot be run by an offset-free controller with `controller_model`;
/// nothing where they can.
[[nodiscard]] std::optional<std::string> why_not_stabilisable(
    const ModelSpec& controller_model, const std::vector<PlantStage>& stages, int mv_count,
    const std::vector<double>& cv_weights);

}  // namespace mpm::sim
