#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "tests/hidden/cv_noise.hpp"
#include "tests/hidden/draft.hpp"
#include "tests/hidden/loop.hpp"
#include "tests/hidden/true_plant.hpp"

/// What a case starts from, before anything is hidden.
namespace mpm::hidden {

[[nodiscard]] std::string plant_path(const std::string& plant);
/// A file of config/plants. Throws std::runtime_error where it cannot be read.
[[nodiscard]] config::UnitConfig load_plant(const std::string& plant);

/// The unit's own noise. With the hard setting each CV's is of another colour, 0.5 .. 2 times the
/// level, and in a third of the seeds Student's t with 4 .. 5 degrees of freedom.
[[nodiscard]] std::vector<CvNoise> draw_noise_model(const config::UnitConfig& unit, bool hard,
                                                    std::uint64_t seed);

/// How the unit file lets its measured disturbances wander: samples x DVs, own units.
[[nodiscard]] Eigen::MatrixXd draw_dvs(const config::UnitConfig& unit, const TruePlantSpec& plant,
                                       int samples, std::uint64_t seed);

/// Errors that every model has: Gaussian, 2 % in gain and 3 % in time constant, cut at two s.d.
/// Leaves out the channels whose gain, lag or dead time is what was hidden.
void add_background(TruePlantSpec& plant, const std::vector<TrueEffect>& hidden, std::uint64_t seed,
                    std::uint64_t attempt);

[[nodiscard]] Healthy summarise_healthy(const LoopRecord& record, const TruePlantSpec& plant,
                                        int mv_count);

}  // namespace mpm::hidden
