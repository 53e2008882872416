#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model/model_spec.hpp"

namespace mpm {

/// Time constants (samples) that what a wrong first state adds to a CV dies out with: the shortest,
/// the middle and the longest of its channels', those that differ by a fifth.
[[nodiscard]] std::vector<double> decay_times(const ModelSpec& model, int cv);

/// `simulated`, which began at rest, as it is if it begins where the measurements do: decays fitted
/// to the first rows (one longest time constant, at least 20, at most a quarter) are added
/// throughout.
[[nodiscard]] Eigen::VectorXd start_on_data(const Eigen::Ref<const Eigen::VectorXd>& simulated,
                                            const Eigen::Ref<const Eigen::VectorXd>& measured,
                                            const std::vector<double>& decay_times);

/// Root mean square of what the simulation is off by in the first few rows.
[[nodiscard]] double first_error(const Eigen::Ref<const Eigen::VectorXd>& simulated,
                                 const Eigen::Ref<const Eigen::VectorXd>& measured);

/// Mean of measured - simulated where it is known; 0 where it nowhere is.
[[nodiscard]] double mean_error(const Eigen::Ref<const Eigen::VectorXd>& simulated,
                                const Eigen::Ref<const Eigen::VectorXd>& measured);

}  // namespace mpm
