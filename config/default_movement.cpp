#include "config/default_movement.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/linear_model.hpp"

namespace mpm::config {
namespace {

// Of an MV that moves by half a unit, and of Shell's plant file: noise beside set-point moves.
constexpr double kMvMovement = 0.5, kNoiseShare = 0.02;
// White noise of this s.d. behind the default pole of 0.95 moves by half a unit.
constexpr double kInputSigma = 0.15;
constexpr double kHoldTimeConstants = 4.0;
constexpr int kShortestHold = 50, kLongestHold = 1000;  // samples

}  // namespace

void give_default_movement(UnitConfig& config) {
  if (!config.has_model()) return;
  const LinearModel model(config.model);
  const double slowest = model.slowest_time_constant_samples();
  const Eigen::MatrixXd gains = model.steady_gain();
  const auto integrating = model.integrating();
  SimulationSettings& simulation = config.simulation;
  for (std::size_t j = 0; j < config.cv.size(); ++j) {
    const auto cv = static_cast<Eigen::Index>(j);
    double square = 0.0;
    for (std::size_t i = 0; i < config.mv.size(); ++i) {
      const auto input = static_cast<Eigen::Index>(i);
      square += std::pow(gains(cv, input) * (integrating(cv, input) ? slowest : 1.0), 2);
    }
    if (square == 0.0) continue;
    simulation.setpoints[j].amplitude = kMvMovement * std::sqrt(square);
    simulation.setpoints[j].hold_samples = static_cast<int>(
        std::clamp<double>(kHoldTimeConstants * slowest, kShortestHold, kLongestHold));
    simulation.noise[j].sigma = kNoiseShare * simulation.setpoints[j].amplitude;
  }
  for (NoiseSettings& movement : simulation.dv_movement) movement.sigma = kInputSigma;
  for (NoiseSettings& movement : simulation.aux_movement) movement.sigma = kInputSigma;
}

}  // namespace mpm::config
