#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "config/scenario_config.hpp"
#include "sim/signals/coloured_noise.hpp"
#include "sim/signals/intervals.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

/// All that adds itself to the plant's outputs: the unit's noise on every CV with what a scenario
/// changes in it, and the scenario's disturbances.
///
///   v_j(k) = own_j(k) + sum gain own_leader(k - lag) + sum of the disturbances of CV j
///
/// own_j is `ColouredNoise`, its innovations normal or Student's t, scaled to s.d. 1 by
/// sqrt((f - 2) / f), times the product of the sigma ratios in force. A lagged step is
/// x(k) = a x(k-1) + (1 - a) size with a = exp(-h / T), x towards 0 after its end. Each random
/// number comes from a stream of its CV and purpose. No allocation after construction.
class OutputDisturbance {
 public:
  /// Throws std::invalid_argument on tags that the unit does not have.
  OutputDisturbance(const config::UnitConfig& unit, const config::ScenarioConfig& scenario,
                    std::uint64_t seed);

  /// v(k) of the next interval, starting with k = 0.
  [[nodiscard]] const Eigen::VectorXd& next();

 private:
  struct NoiseLevel {
    IntervalRange range;
    Eigen::Index cv;
    double ratio;
  };
  struct Tails {
    IntervalRange range;
    Eigen::Index cv;
    double freedom, scale;
    RandomStream stream;
  };
  struct Coupling {
    IntervalRange range;
    Eigen::Index cv, leader;
    std::int64_t lag;
    double gain;
  };
  struct Shape {
    config::DisturbanceKind kind;
    IntervalRange range;
    Eigen::Index cv;
    double size;
    double factor;  ///< pole, samples of a ramp, or radians per sample
    double phase;   ///< radians
    double state;
    RandomStream stream;
  };
  void add_noise_change(const config::NoiseChange& change, const config::UnitConfig& unit,
                        std::uint64_t seed);
  void add_shape(const config::Disturbance& disturbance, const config::UnitConfig& unit,
                 std::uint64_t seed);
  void compute_own();
  [[nodiscard]] double value_of(Shape& shape) const;

  std::vector<ColouredNoise> noise_;
  std::vector<NoiseLevel> levels_;
  std::vector<Tails> tails_;
  std::vector<Coupling> couplings_;
  std::vector<Shape> shapes_;
  Eigen::VectorXd level_, value_;
  Eigen::MatrixXd own_;  ///< a column per interval, round and round
  std::int64_t interval_ = 0;
};

}  // namespace mpm::sim
