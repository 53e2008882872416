#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// 1 for the rows that are known and of which so many rows before are, in the same run; 0 for all
/// others. `known`: 1 or 0.
[[nodiscard]] Eigen::VectorXd rows_with_past(const Eigen::Ref<const Eigen::VectorXd>& known,
                                             const std::vector<Run>& runs, Eigen::Index past);

/// s.d. of the innovations that most rows of a weight have, whatever a few do; 0 where none has
/// one.
[[nodiscard]] double usual_sd(const Eigen::Ref<const Eigen::VectorXd>& innovations,
                              const Eigen::Ref<const Eigen::VectorXd>& weights);

/// Weights of rows by their innovations, so that no stretch and no outlier decides: each is divided
/// by the variance around it relative to the whole (a robust one, over about 300 rows), and counts
/// less beyond three s.d. (Huber's weights squared, as in the channel test). Rows of weight zero
/// stay so.
void reweigh(const Eigen::Ref<const Eigen::VectorXd>& innovations, Eigen::VectorXd& weights);

}  // namespace mpm
