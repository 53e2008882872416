#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "config/unit_config.hpp"
#include "tests/hidden/true_plant.hpp"

namespace mpm::hidden {

/// What happens around the plant, drawn before the loop runs.
struct Surroundings {
  Eigen::MatrixXd noise;  ///< samples x CVs
  Eigen::MatrixXd dvs;    ///< samples x measured disturbances of the model, own units
  Eigen::MatrixXd aux;    ///< samples x other measured signals, own units
};

struct LoopRecord {
  Eigen::MatrixXd inputs;  ///< samples x model inputs
  Eigen::MatrixXd cvs;     ///< samples x CVs
  bool finite = true;
};

/// The true plant under mpmsim's controller, which believes `unit.model`: random binary set-points
/// as the unit file has them. y(k) is measured, then u(k) computed.
[[nodiscard]] LoopRecord run_loop(const config::UnitConfig& unit, const TruePlantSpec& spec,
                                  const Surroundings& around, std::uint64_t seed);

}  // namespace mpm::hidden
